// SPDX-License-Identifier: BSD-3-Clause
#include "loop/coverage_trace.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "helixnav/core/angle.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double circle_lap_m = 2000.0;
constexpr double trace_spacing_m = 4.0;
constexpr double no_end_m = std::numeric_limits<double>::infinity();

core::Pose2 on_circle(double path_m) {
  const double angle_rad = 2.0 * core::pi * path_m / circle_lap_m;
  const double radius_m = circle_lap_m / (2.0 * core::pi);
  return {radius_m * std::sin(angle_rad), radius_m * (1.0 - std::cos(angle_rad)), angle_rad};
}

bool not_needed(double) { return false; }

/// Laps of 500 poses, thinned after each step as the navigator does.
CoverageTrace laps_thinned(int count, const std::function<bool(double)>& needed) {
  CoverageTrace trace(trace_spacing_m);
  for (int i = 0; i < count * 500; ++i) {
    const double path_m = trace_spacing_m * i;
    trace.pass(path_m, on_circle(path_m));
    trace.thin_before(path_m - 400.0, needed);
  }
  return trace;
}

TEST(CoverageTrace, BeginsAfterAPlaceOfTheDrive) {
  CoverageTrace trace(trace_spacing_m);
  for (int i = 0; i < 10; ++i) trace.pass(trace_spacing_m * i, on_circle(trace_spacing_m * i));
  trace.begin_after(trace_spacing_m * 3);
  EXPECT_EQ(trace.size(), 6u);
  EXPECT_TRUE(trace.between(0.0, trace_spacing_m * 4).empty());
}

TEST(CoverageTrace, IsAsLargeAsTheGroundHoweverLongTheDrive) {
  EXPECT_LE(laps_thinned(10, not_needed).size(), 4096u);
  EXPECT_LE(laps_thinned(100, not_needed).size(), 4096u);
}

TEST(CoverageTrace, KeepsTheFirstLapAndWhatWasPassedLately) {
  const CoverageTrace trace = laps_thinned(100, not_needed);
  EXPECT_EQ(trace.between(0.0, circle_lap_m).size(), 500u);
  EXPECT_EQ(trace.between(99.5 * circle_lap_m, no_end_m).size(), 250u);
}

TEST(CoverageTrace, KeepsEveryPoseOfNewGround) {
  CoverageTrace trace(trace_spacing_m);
  for (int i = 0; i < 20000; ++i) {
    trace.pass(trace_spacing_m * i, {trace_spacing_m * i, 0.0, 0.0});
    trace.thin_before(trace_spacing_m * i - 400.0, not_needed);
  }
  EXPECT_EQ(trace.size(), 20000u);
}

TEST(CoverageTrace, KeepsWhatLooksTheOtherWay) {
  CoverageTrace trace(trace_spacing_m);
  for (int i = 0; i < 4096; ++i) {
    const bool back = i >= 2048;
    trace.pass(trace_spacing_m * i, {trace_spacing_m * (back ? 4096 - i : i), 0.0, back ? core::pi : 0.0});
  }
  trace.thin_before(no_end_m, not_needed);
  EXPECT_EQ(trace.size(), 4096u);
}

TEST(CoverageTrace, KeepsWhatIsNeeded) {
  const auto third_lap = [](double path_m) { return path_m >= 2.0 * circle_lap_m && path_m < 3.0 * circle_lap_m; };
  EXPECT_EQ(laps_thinned(100, third_lap).between(2.0 * circle_lap_m, 3.0 * circle_lap_m).size(), 500u);
}

}  // namespace
}  // namespace helixnav::supervisor
