// SPDX-License-Identifier: BSD-3-Clause
#include "scan_model.hpp"

#include <gtest/gtest.h>

#include "helixnav/core/observation.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::fastslam {
namespace {

TEST(ScanModel, EqualsTheModelOfCoreForBothKinds) {
  core::RandomStream random(1, "scan model");
  for (int k = 0; k < 2000; ++k) {
    core::Scan scan;
    scan.T_robot_sensor = core::Pose2(random.uniform(-2, 4), random.uniform(-1, 1), random.uniform(-3, 3));
    const core::Pose2 pose(random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-3, 3));
    const Eigen::Vector2d landmark(random.uniform(-60, 60), random.uniform(-60, 60));
    if (k % 2 == 0) {
      scan.observations.push_back(core::make_range_bearing(random.uniform(0.5, 80), random.uniform(-3, 3), 0.1, 0.02));
    } else {
      scan.observations.push_back(
          core::make_cartesian({random.uniform(-40, 40), random.uniform(-40, 40)}, Eigen::Matrix2d::Identity()));
    }
    const core::Observation& z = scan.observations.front();
    const PreparedScan prepared = prepare(scan);
    const TurnedPose turned(pose.vector());
    const Pair pair = compare(prepared, prepared.observations[0], turned, landmark);
    const auto expected = core::predict_observation(z.kind, pose, scan.T_robot_sensor, landmark);
    EXPECT_TRUE(pair.nu.isApprox(core::innovation(z.kind, z.z, expected.z_hat), 1e-9)) << k;
    EXPECT_TRUE(pair.H_pose.isApprox(Eigen::MatrixXd(expected.H_pose), 1e-9)) << k;
    EXPECT_TRUE(pair.H_point.isApprox(Eigen::MatrixXd(expected.H_landmark), 1e-9)) << k;
    const auto located = core::locate_landmark(z, pose, scan.T_robot_sensor);
    EXPECT_TRUE(turned.place(prepared.observations[0].point_robot_m).isApprox(located.point_world_m, 1e-9));
    EXPECT_TRUE(place_by_observation(prepared, prepared.observations[0], turned).isApprox(located.G_z, 1e-9));
  }
}

TEST(ScanModel, AnglesOfTheSeriesAreThoseOfTheArctangent) {
  core::RandomStream random(2, "angles");
  for (int k = 0; k < 100'000; ++k) {
    const double a = k % 2 == 0 ? random.uniform(-0.11, 0.11) : random.uniform(-core::pi, core::pi);
    const double r = random.uniform(0.1, 100.0), y = r * std::sin(a), x = r * std::cos(a);
    ASSERT_NEAR(angle_of(y, x), std::atan2(y, x), 4e-16 + 4e-16 * std::abs(a)) << a;
  }
}

TEST(ScanModel, ViewHoldsWhatRangeAndBearingSay) {
  core::RandomStream random(3, "view");
  for (int k = 0; k < 20'000; ++k) {
    core::FieldOfView view{random.uniform(0.0, 2.0), random.uniform(4.0, 9.0), 0.0, 0.0};
    view.min_bearing_rad = random.uniform(-core::pi, 1.0);
    view.max_bearing_rad = view.min_bearing_rad + random.uniform(0.1, core::pi - view.min_bearing_rad);
    const double r = random.uniform(0.0, 10.0), b = random.uniform(-core::pi, core::pi);
    const bool expected =
        r >= view.min_range_m && r <= view.max_range_m && b >= view.min_bearing_rad && b <= view.max_bearing_rad;
    EXPECT_EQ(ViewTest(view, 1.0, 0.0).sees(r * std::cos(b), r * std::sin(b)), expected) << r << " " << b;
  }
  EXPECT_TRUE(ViewTest({0.0, 5.0, -core::pi, core::pi}, 1.0, 0.0).sees(-3.0, 0.0));
  EXPECT_FALSE(ViewTest({0.0, 5.0, -core::pi, core::pi}, 0.9, 0.0).sees(-4.6, 0.0));
}

}  // namespace
}  // namespace helixnav::fastslam
