// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "helixnav/supervisor/joint_map.hpp"
#include "placing/names_of_factors.hpp"
#include "placing/place_by_points.hpp"

namespace helixnav::supervisor {
namespace {

template <class Value>
void keep_those(const std::vector<std::size_t>& which, std::vector<Value>& values) {
  if (values.empty()) return;
  std::vector<Value> kept;
  for (const std::size_t i : which) kept.push_back(values[i]);
  values = std::move(kept);
}

/// What an earlier session saw a few times and never confirmed is clutter for the most part, and where it stands beside a landmark,
/// that one would be taken for it.
void forget_tentative(core::JointMap& map) {
  std::vector<std::size_t> mature;
  std::vector<Eigen::Index> rows{0, 1, 2};
  for (std::size_t i = 0; i < map.joint.ids.size(); ++i) {
    if (map.states[i] != core::LandmarkState::mature) continue;
    mature.push_back(i);
    const auto row = 3 + 2 * static_cast<Eigen::Index>(i);
    rows.insert(rows.end(), {row, row + 1});
  }
  if (mature.size() == map.joint.ids.size()) return;
  if (map.has_covariance()) map.joint.covariance = map.joint.covariance(rows, rows).eval();
  keep_those(mature, map.joint.ids);
  keep_those(mature, map.joint.points_m);
  keep_those(mature, map.states);
  keep_those(mature, map.observations);
  keep_those(mature, map.appearances);
  keep_those(mature, map.covariances_m2);
  if (map.factors == nullptr) return;
  auto factors = std::make_shared<core::MapFactors>(*map.factors);
  keep_names(map.joint.ids, *factors);
  map.factors = std::move(factors);
}

/// Mature landmarks, the nearest dozen.
std::vector<std::size_t> landmarks_around(const core::JointMap& map, const Eigen::Vector2d& point_m) {
  constexpr std::size_t most = 12;
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < map.joint.ids.size(); ++i) {
    if (map.states[i] != core::LandmarkState::mature) continue;
    near.emplace_back((map.joint.points_m[i] - point_m).norm(), i);
  }
  std::sort(near.begin(), near.end());
  std::vector<std::size_t> around;
  for (std::size_t k = 0; k < std::min(most, near.size()); ++k) around.push_back(near[k].second);
  std::sort(around.begin(), around.end());
  return around;
}

/// The pose shares the errors of the landmarks around it.
void correlate(const core::PoseGaussian& pose, const std::vector<std::size_t>& around, core::JointGaussian& joint) {
  std::vector<Eigen::Vector2d> points_m;
  std::vector<Eigen::Index> rows;
  for (const std::size_t i : around) {
    points_m.push_back(joint.points_m[i]);
    const auto row = 3 + 2 * static_cast<Eigen::Index>(i);
    rows.insert(rows.end(), {row, row + 1});
  }
  const Eigen::MatrixXd by_points = place_by_points(pose.mean, points_m);
  Eigen::MatrixXd& P = joint.covariance;
  const Eigen::Index landmarks = P.rows() - 3;
  P.topRightCorner(3, landmarks) = by_points * P(rows, Eigen::seqN(3, landmarks));
  P.bottomLeftCorner(landmarks, 3) = P.topRightCorner(3, landmarks).transpose();
  const Eigen::Matrix3d shared = P(Eigen::seqN(0, 3), rows) * by_points.transpose();
  P.topLeftCorner<3, 3>() = pose.covariance + 0.5 * (shared + shared.transpose());
}

}  // namespace

core::JointMap begun_at(core::JointMap map, const core::PoseGaussian& pose) {
  forget_tentative(map);
  const std::vector<std::size_t> around = landmarks_around(map, pose.mean.position_m());
  map.joint.pose = pose.mean;
  map.has_end = true;
  Eigen::MatrixXd& P = map.joint.covariance;
  P.topRows(3).setZero();
  P.leftCols(3).setZero();
  P.topLeftCorner<3, 3>() = pose.covariance;
  constexpr std::size_t least_around = 2;  // that give a place and a heading
  if (around.size() < least_around) return map;
  if (map.has_covariance()) correlate(pose, around, map.joint);
  map.given.emplace();
  map.given->pose = pose;
  for (const std::size_t i : around) map.given->around.push_back(map.joint.ids[i]);
  return map;
}

}  // namespace helixnav::supervisor
