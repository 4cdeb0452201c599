// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/sim/ihgr_circle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"

namespace helixnav::sim {
namespace {

TEST(IhgrCircle, GoesRoundTheCircleOneDegreeASampleAndCloses) {
  const core::Recording recording = simulate_ihgr_circle({}, 1);
  ASSERT_EQ(recording.true_poses.size(), 361u);
  const Eigen::Vector2d centre_map_m(0.0, 5.0);  // the circle is to the left of the start
  for (std::size_t i = 0; i < recording.true_poses.size(); ++i) {
    const core::Pose2& pose = recording.true_poses[i].T_world_robot;
    EXPECT_NEAR((pose.position_m() - centre_map_m).norm(), 5.0, 1e-9);
    EXPECT_NEAR(core::wrap_to_pi(pose.heading_rad - static_cast<double>(i) * core::pi / 180.0), 0.0, 1e-9);
  }
  EXPECT_LT(recording.true_poses.back().T_world_robot.position_m().norm(), 1e-9);
}

TEST(IhgrCircle, HasTwelveFeaturesInTheSquareAndFiveWhereThePaperHasThem) {
  IhgrCircle world;
  world.close_features = true;
  const core::Recording recording = simulate_ihgr_circle(world, 7);
  const core::Recording free = simulate_ihgr_circle({}, 7);
  ASSERT_EQ(recording.true_landmarks.size(), 12u);
  const core::Pose2 T_world_map(15.0, 10.0, core::pi / 2.0);
  const Eigen::Vector2d third_m = core::transform(T_world_map, recording.true_landmarks[2].point_m);
  EXPECT_NEAR(third_m.x(), 2.4, 1e-9);
  EXPECT_NEAR(third_m.y(), 1.9, 1e-9);
  for (std::size_t i = 0; i < 12; ++i) {
    const Eigen::Vector2d point_m = core::transform(T_world_map, recording.true_landmarks[i].point_m);
    EXPECT_TRUE(point_m.minCoeff() >= 0.0 && point_m.maxCoeff() <= 20.0) << point_m.transpose();
    if (i >= 5) {  // the others are where they are without the five
      EXPECT_EQ(recording.true_landmarks[i].point_m, free.true_landmarks[i].point_m);
    }
  }
}

// Normalised errors of all observations and increments: χ² bounds at ±5σ of their sums, false alarm below 1e-6 each.
TEST(IhgrCircle, DrawsTheNoiseThatItTells) {
  double z_sum = 0.0;
  double z_rows = 0.0;
  double u_sum = 0.0;
  double u_rows = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const core::Recording recording = simulate_ihgr_circle({}, seed);
    std::size_t scans = 0;
    for (const core::Event& event : recording.events) {
      if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
        const double turn_error_rad = odometry->T_before_after.heading_rad - core::pi / 180.0;
        u_sum += turn_error_rad * turn_error_rad / odometry->covariance(2, 2);
        u_rows += 1.0;
        continue;
      }
      const auto& scan = std::get<core::Scan>(event);
      const core::Pose2& pose = recording.true_poses[scans].T_world_robot;
      for (std::size_t k = 0; k < scan.observations.size(); ++k) {
        const core::Observation& seen = scan.observations[k];
        const auto label = static_cast<std::size_t>(recording.labels[scans][k]);
        const core::ObsVector z_hat =
            core::predict_observation(seen.kind, pose, {}, recording.true_landmarks[label].point_m).z_hat;
        const Eigen::Vector2d nu = core::innovation(seen.kind, seen.z, z_hat);
        z_sum += nu[0] * nu[0] / seen.R(0, 0) + nu[1] * nu[1] / seen.R(1, 1);
        z_rows += 2.0;
      }
      ++scans;
    }
  }
  EXPECT_GT(z_rows, 20000.0);
  EXPECT_NEAR(z_sum / z_rows, 1.0, 5.0 * std::sqrt(2.0 / z_rows));
  EXPECT_NEAR(u_sum / u_rows, 1.0, 5.0 * std::sqrt(2.0 / u_rows));
}

TEST(IhgrCircle, KeepsTheLayoutUnderAnotherNoiseAndRepeatsItself) {
  IhgrCircle noisy;
  noisy.sigma_range_m = 0.3;
  const core::Recording a = simulate_ihgr_circle({}, 3);
  const core::Recording b = simulate_ihgr_circle(noisy, 3);
  const core::Recording c = simulate_ihgr_circle({}, 3);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(a.true_landmarks[i].point_m, b.true_landmarks[i].point_m);
  const auto& last_a = std::get<core::Scan>(a.events.back());
  const auto& last_c = std::get<core::Scan>(c.events.back());
  ASSERT_EQ(last_a.observations.size(), last_c.observations.size());
  for (std::size_t k = 0; k < last_a.observations.size(); ++k) {
    EXPECT_EQ(last_a.observations[k].z, last_c.observations[k].z);
  }
}

TEST(IhgrCircle, RefusesQuantitiesOutOfTheirRange) {
  const auto refused = [](auto change) {
    IhgrCircle world;
    change(world);
    EXPECT_THROW(simulate_ihgr_circle(world, 1), core::InputError);
  };
  refused([](IhgrCircle& w) { w.features = -1; });
  refused([](IhgrCircle& w) { w.close_features = true, w.features = 4; });
  refused([](IhgrCircle& w) { w.samples = -1; });
  refused([](IhgrCircle& w) { w.radius_m = 0.0; });
  refused([](IhgrCircle& w) { w.sigma_range_m = std::numeric_limits<double>::quiet_NaN(); });
  refused([](IhgrCircle& w) { w.sigma_turn_rad = -1.0; });
  refused([](IhgrCircle& w) { w.field_of_view.max_range_m = std::numeric_limits<double>::infinity(); });
  refused([](IhgrCircle& w) { w.field_of_view.max_bearing_rad = w.field_of_view.min_bearing_rad; });
}

}  // namespace
}  // namespace helixnav::sim
