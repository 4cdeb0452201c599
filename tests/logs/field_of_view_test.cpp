// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/field_of_view.hpp"

#include <cmath>
#include <variant>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"

namespace helixnav::logs {
namespace {

/// Detections across a whole view, one in two hundred of them false and somewhere else.
core::Recording detections(const core::FieldOfView& view, bool polar) {
  core::RandomStream random(3, "field_of_view_test");
  core::Recording recording;
  for (int k = 0; k < 500; ++k) {
    core::Scan scan;
    for (int i = 0; i < 6; ++i) {
      const bool is_false = (6 * k + i) % 200 == 0;
      const double square = random.uniform(view.min_range_m * view.min_range_m, view.max_range_m * view.max_range_m);
      const double range_m = is_false ? 10.0 * view.max_range_m : std::sqrt(square);
      const double bearing_rad = random.uniform(view.min_bearing_rad, view.max_bearing_rad);
      const Eigen::Vector2d ahead(std::cos(bearing_rad), std::sin(bearing_rad));
      scan.observations.push_back(polar ? core::make_range_bearing(range_m, bearing_rad, 0.1, 0.01)
                                        : core::make_cartesian(range_m * ahead, 0.01 * Eigen::Matrix2d::Identity()));
    }
    recording.events.emplace_back(scan);
  }
  return recording;
}

TEST(FieldOfView, IsEstimatedForSensorsOfAnyReachAndWidth) {
  for (const core::FieldOfView& view : {core::FieldOfView{1.0, 3.0, -0.7, 0.7}, core::FieldOfView{0.5, 40.0, -2.3, 2.3},
                                        core::FieldOfView{0.0, 12.0, -0.5, 1.5}}) {
    for (const bool polar : {false, true}) {
      const core::FieldOfView found = estimate_field_of_view(detections(view, polar));
      ASSERT_TRUE(found.reach());
      EXPECT_NEAR(*found.reach(), view.max_range_m, 0.05 * view.max_range_m);
      EXPECT_GT(found.max_range_m, 0.8 * view.max_range_m);
      EXPECT_LT(found.max_range_m, view.max_range_m) << "expected is only what lies well inside";
      EXPECT_GE(found.min_range_m, view.min_range_m);
      EXPECT_LT(found.min_range_m, view.min_range_m + 0.2 * view.max_range_m);
      const double width_rad = view.max_bearing_rad - view.min_bearing_rad;
      EXPECT_NEAR(found.min_bearing_rad, view.min_bearing_rad, 0.08 * width_rad);
      EXPECT_NEAR(found.max_bearing_rad, view.max_bearing_rad, 0.08 * width_rad);
    }
  }
}

TEST(FieldOfView, AllAroundIsAllAround) {
  const core::FieldOfView found = estimate_field_of_view(detections({0.5, 20.0, -core::pi, core::pi}, true));
  EXPECT_EQ(found.max_bearing_rad - found.min_bearing_rad, 2.0 * core::pi);
}

TEST(FieldOfView, IsUnknownWhereNoObservationFixesAPoint) {
  core::Recording bearings;
  core::Scan scan;
  scan.field_of_view.min_bearing_rad = -0.75;
  scan.observations = {core::make_bearing(0.2, 0.01)};
  bearings.events.emplace_back(scan);
  EXPECT_FALSE(estimate_field_of_view(bearings).reach());
  estimate_missing_field_of_view(bearings);
  EXPECT_EQ(field_of_view_of(bearings).min_bearing_rad, -0.75);
  EXPECT_FALSE(estimate_field_of_view(core::Recording()).reach());
}

TEST(FieldOfView, ToldIsBelieved) {
  core::Recording recording = detections({0.5, 20.0, -1.0, 1.0}, false);
  estimate_missing_field_of_view(recording);
  GivenFieldOfView given;
  given.max_range_m = 25.0;
  set_field_of_view(recording, given);
  EXPECT_EQ(field_of_view_of(recording).reach(), 25.0);
  EXPECT_LT(field_of_view_of(recording).max_bearing_rad, 1.0);
  given.width_rad = core::pi;
  set_field_of_view(recording, given);
  EXPECT_EQ(field_of_view_of(recording).max_bearing_rad, core::pi / 2);
  EXPECT_EQ(field_of_view_of(recording).max_range_m, 25.0);
}

TEST(FieldOfView, KeepsTheReachBesideAReliableRangeAlone) {
  SensorModel sensor;
  sensor.reliable_range_m = 12.0;
  core::FieldOfView estimated = estimate_field_of_view(detections({0.5, 20.0, -1.0, 1.0}, true));
  const double reach_m = estimated.reach().value();
  tell_view(sensor, estimated);
  EXPECT_EQ(estimated.reach(), reach_m);
  EXPECT_EQ(estimated.max_range_m, 12.0);
  core::FieldOfView unknown;
  tell_view(sensor, unknown);
  EXPECT_EQ(unknown.reach(), 12.0) << "there is nothing else";
}

TEST(EstimateFieldOfView, HasAnAreaWhereAllIsSeenAtOneDistance) {
  core::Recording recording;
  core::Scan scan;
  for (int i = 0; i < 10; ++i) scan.observations.push_back(core::make_range_bearing(5.0, 0.1 * i, 0.1, 0.01));
  recording.events.emplace_back(scan);
  const core::FieldOfView view = estimate_field_of_view(recording);
  EXPECT_LT(view.min_range_m, view.max_range_m);
  EXPECT_EQ(view.max_range_m, 5.0);
  for (core::Observation& observation : std::get<core::Scan>(recording.events[0]).observations) observation.z[1] = 0.3;
  const core::FieldOfView narrow = estimate_field_of_view(recording);
  EXPECT_LT(narrow.min_bearing_rad, narrow.max_bearing_rad) << "all in one direction";
}

}  // namespace
}  // namespace helixnav::logs
