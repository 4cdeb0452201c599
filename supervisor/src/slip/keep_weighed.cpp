// SPDX-License-Identifier: BSD-3-Clause
#include "slip/keep_weighed.hpp"

#include <algorithm>

namespace helixnav::supervisor {

std::vector<Eigen::Vector2d> means_m(const std::vector<SlipLandmark>& landmarks) {
  std::vector<Eigen::Vector2d> means_m;
  for (const SlipLandmark& one : landmarks) means_m.push_back(one.at_m);
  return means_m;
}

void keep_weighed(const core::Pose2& T_world_robot, const core::Scan& scan, const std::vector<SeenPoint>& seen,
                  const SlipComponent& widest, SlipReach reach, std::vector<SlipLandmark>& near) {
  if (seen.size() < most_weighed) return;
  const Eigen::Vector2d sensor_m = core::transform(T_world_robot, scan.T_robot_sensor.position_m());
  const double farthest_m = (seen.back().point_m - scan.T_robot_sensor.position_m()).norm();
  const double range_m = farthest_m + 2.0 * slip_reach_m(widest, seen.back(), spacing_in(reach, means_m(near)));
  const auto is_far = [&](const SlipLandmark& one) { return (one.at_m - sensor_m).norm() > range_m; };
  near.erase(std::remove_if(near.begin(), near.end(), is_far), near.end());
}

}  // namespace helixnav::supervisor
