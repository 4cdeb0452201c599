// SPDX-License-Identifier: BSD-3-Clause
#include "slip/untied.hpp"

#include <algorithm>

#include "helixnav/core/angle.hpp"

namespace helixnav::supervisor {
namespace {

bool was_known(const association::LandmarkRecord& record, double since_m) { return record.born_path_m <= since_m; }

/// Where it is, or else, beyond the window of a large map, where it was seen from.
Eigen::Vector2d place_of(const association::LandmarkRecord& record, const cekf::CompressedEkf& filter) {
  return filter.contains(record.id) ? filter.landmark_mean(record.id) : record.last_hit_at_m;
}

/// Mean of d dᵀ, d from a place to the landmarks known before.
Eigen::Matrix2d second_moment_about(const Eigen::Vector2d& place_m, const cekf::CompressedEkf& filter,
                                    const association::LandmarkLife& existence, double since_m) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  int count = 0;
  for (const association::LandmarkRecord& record : existence.records()) {
    if (record.state != core::LandmarkState::mature || !was_known(record, since_m)) continue;
    const Eigen::Vector2d d = place_of(record, filter) - place_m;
    sum += d * d.transpose();
    ++count;
  }
  return count > 0 ? Eigen::Matrix2d(sum / count) : sum;
}

}  // namespace

bool is_tied_again(const association::LandmarkLife& existence, double since_m) {
  int known = 0, all = 0;
  for (const association::LandmarkRecord& record : existence.records()) {
    if (record.last_seen_path_m <= since_m) continue;
    ++all;
    known += was_known(record, since_m);
  }
  constexpr int least = 5;  // pairs of a place
  constexpr int few = 3;    // at most one in three
  return known >= least && few * known > all;
}

bool is_tied_by(const std::vector<core::MergedLandmarks>& merged, const association::LandmarkLife& existence,
                double since_m) {
  const auto known = std::count_if(merged.begin(), merged.end(), [&](const core::MergedLandmarks& one) {
    return existence.contains(one.kept) && was_known(existence.record(one.kept), since_m);
  });
  return 2 * known > static_cast<std::ptrdiff_t>(merged.size());
}

core::PoseGaussian pose_anywhere(const cekf::CompressedEkf& filter, const association::LandmarkLife& existence,
                                 double since_m, double reach_m) {
  constexpr double any_heading_rad2 = core::pi * core::pi / 3.0;  // uniform
  core::PoseGaussian pose = filter.pose();
  pose.covariance.topLeftCorner<2, 2>() += second_moment_about(pose.mean.position_m(), filter, existence, since_m) +
                                           reach_m * reach_m * Eigen::Matrix2d::Identity();
  pose.covariance(2, 2) += any_heading_rad2;
  return pose;
}

}  // namespace helixnav::supervisor
