// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>

#include "helixnav/core/random.hpp"
#include "helixnav/core/recording.hpp"

namespace helixnav::testing {

/// A vehicle that drives straight past two rows of posts, a step a second: range and bearing with a full covariance,
/// odometry also with a full covariance. Labels are the numbers of the posts; the first scan comes before any motion.
inline core::Recording past_posts(int steps = 20) {
  core::RandomStream random(7, "past posts");
  core::Recording recording;
  recording.name = "past posts";
  Eigen::Matrix3d Q;
  Q << 4e-4, 1e-4, 2e-5, 1e-4, 2e-4, 3e-5, 2e-5, 3e-5, 1e-4;
  for (int step = 0; step <= steps; ++step) {
    const core::Nanoseconds t_ns = core::nanoseconds_from_seconds(step + 1.0);
    if (step > 0) {
      core::Odometry odometry;
      odometry.t_ns = t_ns;
      odometry.T_before_after = core::Pose2(Eigen::Vector3d(1.0, 0.0, 0.0) + random.normal3(Q));
      odometry.covariance = Q;
      recording.events.emplace_back(odometry);
    }
    core::Scan scan;
    scan.t_ns = t_ns;
    scan.T_robot_sensor = core::Pose2(0.5, -0.25, 0.1);
    scan.field_of_view = {0.5, 12.0, -2.0, 2.0};
    recording.labels.emplace_back();
    for (int post = 0; post < 12; ++post) {
      const Eigen::Vector2d point_m(3.0 * (post / 2), post % 2 == 0 ? 5.0 : -4.0);
      const core::Pose2 T_world_sensor = core::compose(core::Pose2(step, 0.0, 0.0), scan.T_robot_sensor);
      const Eigen::Vector2d seen_m = core::transform(core::inverse(T_world_sensor), point_m);
      if (seen_m.norm() > 12.0 || std::abs(std::atan2(seen_m.y(), seen_m.x())) > 2.0) continue;
      core::Observation z =
          core::make_range_bearing(seen_m.norm() + random.normal(0.0, 0.02),
                                   std::atan2(seen_m.y(), seen_m.x()) + random.normal(0.0, 0.005), 0.02, 0.005);
      z.R(0, 1) = z.R(1, 0) = 3e-5;
      scan.observations.push_back(z);
      recording.labels.back().push_back(post);
    }
    recording.events.emplace_back(scan);
  }
  return recording;
}

}  // namespace helixnav::testing
