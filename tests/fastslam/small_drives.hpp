// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/fastslam/fast_slam.hpp"

namespace helixnav::fastslam::test {

struct Stage {
  core::Odometry odometry;
  core::Scan scan;
  std::vector<KnownName> names;
  core::Pose2 truth;
};

/// A drive on a circle among landmarks, with clutter; everything follows from the seed.
inline std::vector<Stage> drive(int scans, std::uint64_t seed, double clutter = 0.2) {
  core::RandomStream random(seed, "small drive");
  std::vector<Eigen::Vector2d> landmarks;
  for (int k = 0; k < 25; ++k) landmarks.emplace_back(random.uniform(-6.0, 16.0), random.uniform(-6.0, 16.0));
  std::vector<Stage> stages;
  core::Pose2 truth;
  for (int i = 0; i < scans; ++i) {
    Stage stage;
    const Eigen::Vector3d sigma(0.02, 0.01, 0.01);
    stage.odometry.covariance = sigma.cwiseAbs2().asDiagonal();
    truth = core::compose(truth, core::Pose2(0.3, 0.0, 0.06));
    stage.truth = truth;
    stage.odometry.T_before_after =
        core::Pose2(Eigen::Vector3d(0.3, 0.0, 0.06) + random.normal3(stage.odometry.covariance));
    stage.odometry.t_ns = stage.scan.t_ns = (i + 1) * 100'000'000LL;
    stage.scan.T_robot_sensor = core::Pose2(0.5, 0.1, 0.05);
    stage.scan.field_of_view = {0.0, 8.0, -1.5, 1.5};
    const core::Pose2 T_sensor_world = core::inverse(core::compose(truth, stage.scan.T_robot_sensor));
    for (std::size_t k = 0; k < landmarks.size(); ++k) {
      const Eigen::Vector2d p = core::transform(T_sensor_world, landmarks[k]);
      if (p.norm() > 8.0 || p.norm() < 0.5 || std::abs(std::atan2(p.y(), p.x())) > 1.5) continue;
      if (!random.bernoulli(0.9)) continue;
      stage.scan.observations.push_back(core::make_range_bearing(
          random.normal(p.norm(), 0.05), random.normal(std::atan2(p.y(), p.x()), 0.01), 0.05, 0.01));
      stage.names.push_back(static_cast<KnownName>(k));
    }
    if (random.bernoulli(clutter)) {
      stage.scan.observations.push_back(
          core::make_range_bearing(random.uniform(1.0, 8.0), random.uniform(-1.5, 1.5), 0.05, 0.01));
      stage.names.push_back(no_name);
    }
    stages.push_back(stage);
  }
  return stages;
}

inline core::StepReport step(FastSlam& slam, const Stage& stage, bool known) {
  slam.predict(stage.odometry);
  return known ? slam.update_known(stage.scan, stage.names) : slam.update(stage.scan);
}

}  // namespace helixnav::fastslam::test
