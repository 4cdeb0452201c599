// SPDX-License-Identifier: BSD-3-Clause
#include "drive/sensors_apart.hpp"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/observation.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::apps {
namespace {

struct TwoSensorDrive {
  core::Recording recording;
  runs::Run run;
};

/// A circle among 40 poles, driven with scans of a sensor ahead and one behind in turn. The one ahead sees everything `farther_m`
/// farther away and `left_rad` farther to the left. The run's poses are off, by the same for scans that follow each other.
TwoSensorDrive two_sensor_drive(double farther_m, double left_rad, std::uint64_t seed, int scans = 2000) {
  core::RandomStream random(seed, "sensors apart test");
  TwoSensorDrive made;
  for (int i = 0; i < 40; ++i) {
    core::MapLandmark pole;
    pole.id = i;
    pole.state = core::LandmarkState::mature;
    pole.point.mean_m = {random.uniform(-40.0, 40.0), random.uniform(-40.0, 40.0)};
    made.run.map.push_back(pole);
  }
  Eigen::Vector2d off_m(0.0, 0.0);
  for (int k = 0; k < scans; ++k) {
    const bool is_ahead = k % 2 == 0;
    const double angle = 0.01 * k;
    const core::Pose2 truth(25.0 * std::cos(angle), 25.0 * std::sin(angle), core::wrap_to_pi(angle + 0.5 * core::pi));
    off_m = 0.98 * off_m + 0.01 * Eigen::Vector2d(random.normal(), random.normal());
    core::Scan scan;
    scan.T_robot_sensor = is_ahead ? core::Pose2(1.0, 0.0, 0.0) : core::Pose2(-1.0, 0.0, core::pi);
    core::StepReport step;
    step.pose.mean = core::Pose2(truth.x_m + off_m.x(), truth.y_m + off_m.y(), truth.heading_rad);
    for (const core::MapLandmark& pole : made.run.map) {
      core::Observation seen;
      seen.kind = core::ObservationKind::range_bearing;
      seen.z = core::predict_observation(seen.kind, truth, scan.T_robot_sensor, pole.point.mean_m).z_hat;
      if (seen.z[0] > 20.0 || std::abs(seen.z[1]) > 1.2) continue;
      seen.z[0] += random.normal(0.0, 0.05) + (is_ahead ? farther_m : 0.0);
      seen.z[1] += random.normal(0.0, 0.01) + (is_ahead ? left_rad : 0.0);
      seen.R = core::ObsMatrix::Zero(2, 2);
      seen.R(0, 0) = 0.05 * 0.05;
      seen.R(1, 1) = 0.01 * 0.01;
      step.associations.push_back({static_cast<int>(scan.observations.size()), core::Outcome::matched, pole.id});
      scan.observations.push_back(seen);
    }
    made.recording.events.emplace_back(scan);
    made.run.steps.push_back(step);
  }
  return made;
}

TEST(SensorsApart, AreFoundWithTheirDifference) {
  const TwoSensorDrive made = two_sensor_drive(0.05, -0.02, 1);
  const auto apart = sensors_apart_of(made.recording, made.run);
  ASSERT_TRUE(apart);
  EXPECT_TRUE(surely_apart(*apart));
  const double sign = apart->T_robot_one.x_m > 0.0 ? 1.0 : -1.0;
  EXPECT_NEAR(sign * apart->farther_m, 0.05, 4.0 * apart->farther_sigma_m);
  EXPECT_NEAR(sign * apart->left_rad, -0.02, 4.0 * apart->left_sigma_rad);
}

// 40 stretches: one of 100 drives exceeds six standard deviations of either mean with a probability of 1 in 10 000.
TEST(SensorsApart, AreNotWhereTheyAgree) {
  for (std::uint64_t seed = 101; seed <= 200; ++seed) {
    const TwoSensorDrive made = two_sensor_drive(0.0, 0.0, seed);
    const auto apart = sensors_apart_of(made.recording, made.run);
    ASSERT_TRUE(apart);
    EXPECT_FALSE(surely_apart(*apart)) << seed;
  }
}

TEST(SensorsApart, AreNoneWithOneSensorOrAShortDrive) {
  const TwoSensorDrive made = two_sensor_drive(0.05, 0.0, 1, 200);
  EXPECT_FALSE(sensors_apart_of(made.recording, made.run));
  TwoSensorDrive alone = two_sensor_drive(0.05, 0.0, 1);
  for (core::Event& event : alone.recording.events) std::get<core::Scan>(event).T_robot_sensor = core::Pose2();
  EXPECT_FALSE(sensors_apart_of(alone.recording, alone.run));
}

}  // namespace
}  // namespace helixnav::apps
