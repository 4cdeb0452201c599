// SPDX-License-Identifier: BSD-3-Clause
#include "nearby.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace helixnav::localization {

Nearby::Nearby(const core::PoseGaussian& pose, const core::Scan& scan, double sigmas) {
  const bool fixes_points = std::all_of(scan.observations.begin(), scan.observations.end(),
                                        [](const core::Observation& o) { return core::dimension(o.kind) == 2; });
  if (!fixes_points) {
    const Eigen::Vector2d sensor_m = core::transform(pose.mean, scan.T_robot_sensor.position_m());
    const double reach_m = scan.field_of_view.max_range_m;
    const bool is_known = reach_m > 0.0;
    discs_.push_back({sensor_m, is_known ? reach_m : std::numeric_limits<double>::infinity()});
    return;
  }
  discs_.reserve(scan.observations.size());
  for (const core::Observation& observation : scan.observations) {
    const core::LocatedLandmark located = core::locate_landmark(observation, pose.mean, scan.T_robot_sensor);
    const Eigen::Matrix2d covariance_m2 = located.G_pose * pose.covariance * located.G_pose.transpose() +
                                          located.G_z * Eigen::Matrix2d(observation.R) * located.G_z.transpose();
    discs_.push_back({located.point_world_m, sigmas * std::sqrt(std::max(0.0, covariance_m2.trace()))});
  }
}

bool Nearby::holds(const Eigen::Vector2d& point_m) const {
  return std::any_of(discs_.begin(), discs_.end(),
                     [&](const Disc& disc) { return (point_m - disc.centre_m).norm() <= disc.radius_m; });
}

}  // namespace helixnav::localization
