// SPDX-License-Identifier: BSD-3-Clause
#include "points_of_scan.hpp"

#include <limits>

#include "helixnav/core/observation.hpp"

namespace helixnav::runs {

std::vector<Eigen::Vector2f> points_of_scan(const core::Scan& scan) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<Eigen::Vector2f> points_m;
  points_m.reserve(scan.observations.size());
  for (const core::Observation& observation : scan.observations) {
    const bool is_point = core::dimension(observation.kind) == 2;
    points_m.emplace_back(nan, nan);
    if (!is_point) continue;
    points_m.back() =
        core::locate_landmark(observation, core::Pose2{}, scan.T_robot_sensor).point_world_m.cast<float>();
  }
  return points_m;
}

}  // namespace helixnav::runs
