// SPDX-License-Identifier: BSD-3-Clause
#include "placing/join_maps.hpp"

#include <algorithm>

#include <Eigen/LU>

#include "closing/branch_pairs.hpp"
#include "placing/place_by_points.hpp"
#include "placing/session_leftovers.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double loosened = 1e4;  ///< of a variance: the pairs count once, not twice

KeptRemoved pairs_of(const relocalize::Place& place) {
  KeptRemoved pairs;
  for (const relocalize::Pair& pair : place.pairs) pairs.emplace_back(pair.map, pair.branch);
  return pairs;
}

std::vector<core::LandmarkId> those_in(const cekf::CompressedEkf& filter, std::vector<core::LandmarkId> ids) {
  const auto gone = [&](core::LandmarkId id) { return !filter.contains(id); };
  ids.erase(std::remove_if(ids.begin(), ids.end(), gone), ids.end());
  return ids;
}

/// Turns pose and points, rows of the matrix.
void turn_rows(double angle_rad, Eigen::MatrixXd& rows) {
  const Eigen::Matrix2d R = core::rotation(angle_rad);
  rows.topRows<2>() = (R * rows.topRows<2>()).eval();
  for (Eigen::Index row = 3; row < rows.rows(); row += 2) {
    rows.middleRows<2>(row) = (R * rows.middleRows<2>(row)).eval();
  }
}

Eigen::MatrixXd turned(const Eigen::MatrixXd& covariance, double angle_rad) {
  Eigen::MatrixXd once = covariance;
  turn_rows(angle_rad, once);
  Eigen::MatrixXd twice = once.transpose();
  turn_rows(angle_rad, twice);
  return twice;
}

/// How T moves when the map's landmarks of the pairs do. Any fit would do, since its residual is far within the loosened
/// covariance.
Eigen::MatrixXd place_by_map(const core::Pose2& T, const core::JointGaussian& earlier, const KeptRemoved& pairs) {
  std::vector<Eigen::Vector2d> points_m;
  std::vector<Eigen::Index> columns;
  for (const auto& [kept, removed] : pairs) {
    const auto at = std::find(earlier.ids.begin(), earlier.ids.end(), kept) - earlier.ids.begin();
    points_m.push_back(earlier.points_m[static_cast<std::size_t>(at)]);
    columns.push_back(2 * at);
  }
  const Eigen::MatrixXd fit = place_by_points(T, points_m);
  Eigen::MatrixXd by_map = Eigen::MatrixXd::Zero(3, 2 * static_cast<Eigen::Index>(earlier.ids.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    by_map.middleCols<2>(columns[i]) += fit.middleCols<2>(2 * static_cast<Eigen::Index>(i));
  }
  return by_map;
}

PlaceOnMap place_on(const core::JointGaussian& earlier, const relocalize::Place& place, const KeptRemoved& pairs) {
  const Eigen::Matrix3d covariance = loosened * place.information.inverse();
  return {{place.T_map_branch, 0.5 * (covariance + covariance.transpose())},
          place_by_map(place.T_map_branch, earlier, pairs)};
}

}  // namespace

SearchOptions across_sessions(SearchOptions options, double pair_noise_m, std::size_t pairs) {
  options.merge_sigma_m = options.duplicate_sigma_m = pair_noise_m;
  options.most_dropped = most_dropped_of(pairs);
  return options;
}

core::JointGaussian side_by_side(const core::JointGaussian& session, const core::JointGaussian& earlier,
                                 const PlaceOnMap& place) {
  const core::Pose2& T = place.T_map_session.mean;
  const auto own = session.covariance.rows();
  const auto other = earlier.covariance.rows() - 3;
  core::JointGaussian joint;
  joint.pose = core::compose(T, session.pose);
  Eigen::MatrixXd common(own, 3);  // of the session's errors, those of T
  common.topRows<3>() = core::compose_jacobians(T, session.pose).J_first;
  for (std::size_t i = 0; i < session.ids.size(); ++i) {
    joint.ids.push_back(session.ids[i]);
    joint.points_m.push_back(core::transform(T, session.points_m[i]));
    common.middleRows<2>(3 + 2 * static_cast<Eigen::Index>(i)) = point_by_place(T, joint.points_m.back());
  }
  joint.ids.insert(joint.ids.end(), earlier.ids.begin(), earlier.ids.end());
  joint.points_m.insert(joint.points_m.end(), earlier.points_m.begin(), earlier.points_m.end());
  const auto of_map = earlier.covariance.bottomRightCorner(other, other);
  const Eigen::MatrixXd with_map = place.by_map * of_map;  // covariance of T with the map's landmarks
  const Eigen::Matrix3d of_place = place.T_map_session.covariance + with_map * place.by_map.transpose();
  joint.covariance.resize(own + other, own + other);
  Eigen::MatrixXd moved = turned(session.covariance, T.heading_rad);
  moved.noalias() += common * of_place * common.transpose();
  joint.covariance.topLeftCorner(own, own) = 0.5 * (moved + moved.transpose());
  joint.covariance.topRightCorner(own, other).noalias() = common * with_map;
  joint.covariance.bottomLeftCorner(other, own) = joint.covariance.topRightCorner(own, other).transpose();
  joint.covariance.bottomRightCorner(other, other) = of_map;
  return joint;
}

JoinedMaps join_maps(const cekf::CompressedEkf& session, const core::JointGaussian& earlier,
                     const relocalize::Place& place, const std::vector<core::LandmarkId>& confirmed,
                     const std::vector<core::LandmarkId>& unconfirmed, double pair_noise_m,
                     const SearchOptions& options, LeftTwice left_twice) {
  KeptRemoved pairs = pairs_of(place);
  const core::JointGaussian both =
      side_by_side(session.joint(session.landmarks()), earlier, place_on(earlier, place, pairs));
  JoinedMaps joined{cekf::CompressedEkf(both, session.next_name(), session.options()), {}, place.T_map_branch};
  const SearchOptions across = across_sessions(options, pair_noise_m, pairs.size());
  const SessionLeftovers leftovers_of_session(joined.filter, earlier, confirmed, across);
  Closing& closing = joined.closing;
  constexpr int of_place = 3;  // loosened
  if (!make_compatible(joined.filter, across, pairs, closing, of_place)) return joined;
  joined.filter.merge(pairs, across.merge_sigma_m);
  note(pairs, closing);
  closing.accepted = true;
  leftovers_of_session.merge_one_by_one(joined.filter, closing);
  if (left_twice == LeftTwice::in_segments) leftovers_of_session.merge_segments(joined.filter, closing);
  forget_copies(joined.filter, those_in(joined.filter, unconfirmed), earlier.ids, across, closing);
  return joined;
}

}  // namespace helixnav::supervisor
