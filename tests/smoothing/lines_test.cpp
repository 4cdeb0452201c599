// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "helixnav/core/chi2.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/smoothing/smooth.hpp"

namespace helixnav::smoothing {
namespace {

/// Two rounds of a corridor with vertical lines on its walls, seen as bearings by the DLR robot's camera.
struct Drive {
  std::vector<core::Event> events;
  std::vector<std::vector<std::int64_t>> ids;
  std::vector<Eigen::Vector2d> lines_m;
};

Drive drive_past_lines(std::uint64_t seed) {
  core::RandomStream random(seed, "lines");
  Drive drive;
  constexpr int steps_per_round = 120;
  constexpr double radius_m = 6.0;
  for (int i = 0; i < 60; ++i) {
    const double angle = random.uniform(-core::pi, core::pi);
    const double distance_m = radius_m + (i % 2 == 0 ? 1.5 : -1.5) + random.uniform(-0.4, 0.4);
    drive.lines_m.emplace_back(distance_m * std::sin(angle), radius_m - distance_m * std::cos(angle));
  }
  const core::Pose2 T_robot_sensor(0.0808609, 0.0179777, 0.0);
  const core::Pose2 step(2.0 * core::pi * radius_m / steps_per_round, 0.0, 2.0 * core::pi / steps_per_round);
  const Eigen::Matrix3d C = Eigen::Vector3d(1e-4, 1e-4, 4e-5).asDiagonal();
  core::Pose2 pose;
  for (int k = 0; k < 2 * steps_per_round; ++k) {
    pose = core::compose(pose, step);
    core::Odometry odometry;
    odometry.T_before_after = core::Pose2(step.vector() + random.normal3(C));
    odometry.covariance = C;
    core::Scan scan;
    scan.T_robot_sensor = T_robot_sensor;
    drive.ids.emplace_back();
    for (std::size_t l = 0; l < drive.lines_m.size(); ++l) {
      const core::Pose2 camera = core::compose(pose, T_robot_sensor);
      const double range_m = (drive.lines_m[l] - camera.position_m()).norm();
      if (range_m < 1.0 || range_m > 5.0) continue;
      const double bearing_rad =
          core::predict_observation(core::ObservationKind::bearing, pose, T_robot_sensor, drive.lines_m[l]).z_hat[0];
      if (std::abs(bearing_rad) > 0.7) continue;
      scan.observations.push_back(core::make_bearing(core::wrap_to_pi(bearing_rad + 0.003 * random.normal()), 0.003));
      drive.ids.back().push_back(static_cast<std::int64_t>(l));
    }
    drive.events.emplace_back(odometry);
    drive.events.emplace_back(scan);
  }
  return drive;
}

TEST(Lines, SeenAsBearingsOnlyGiveAConsistentMap) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Drive drive = drive_past_lines(seed);
    Problem problem = build_problem(drive.events, drive.ids);
    SmoothOptions options;
    options.start = Start::grown;
    options.poses_per_stage = 20;
    const Report report = smooth(problem, options);
    EXPECT_EQ(report.reason, Reason::converged);
    // Both tails have probability 1e-6.
    EXPECT_GT(report.chi2.total(), core::chi2_quantile(1e-6, report.dof)) << "dof " << report.dof;
    EXPECT_LT(report.chi2.total(), core::chi2_quantile(1.0 - 1e-6, report.dof)) << "dof " << report.dof;
    for (const auto& landmark : problem.graph.landmarks) {
      EXPECT_LT((landmark.point_m - drive.lines_m[static_cast<std::size_t>(landmark.name)]).norm(), 0.5)
          << landmark_name(problem, 0);
    }
  }
}

}  // namespace
}  // namespace helixnav::smoothing
