// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/lengths.hpp"

#include <limits>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

core::FieldOfView half_disc(double reach_m) { return {0.0, reach_m, -core::pi / 2, core::pi / 2}; }

core::Pose2 scaled(const core::Pose2& pose, double scale) {
  return {scale * pose.x_m, scale * pose.y_m, pose.heading_rad};
}

/// The drive through a scale model of the world: every length times `scale`, including noise and sensor.
core::Recording scaled(core::Recording run, double scale) {
  const Eigen::Vector3d of_pose(scale, scale, 1.0);
  for (core::Event& event : run.events) {
    if (auto* odometry = std::get_if<core::Odometry>(&event)) {
      odometry->T_before_after = scaled(odometry->T_before_after, scale);
      odometry->covariance = of_pose.asDiagonal() * odometry->covariance * of_pose.asDiagonal();
    } else if (auto* scan = std::get_if<core::Scan>(&event)) {
      scan->T_robot_sensor = scaled(scan->T_robot_sensor, scale);
      scan->field_of_view.min_range_m *= scale;
      scan->field_of_view.max_range_m *= scale;
      for (core::Observation& observation : scan->observations) {
        const Eigen::Vector2d of_polar(scale, 1.0);
        observation.z[0] *= scale;
        observation.R = of_polar.asDiagonal() * observation.R * of_polar.asDiagonal();
      }
    }
  }
  return run;
}

struct Navigated {
  std::vector<core::AssociationReport> associations;
  std::size_t before_search = 0;  ///< of them, before the first decision
  int closed = 0;
  core::Pose2 end;
};

Navigated navigate(const core::Recording& run) {
  NavigatorOptions options;
  options.search.relocalizer.threads = 1;
  Navigator navigator(run.start, options);
  Navigated navigated;
  bool decided = false;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t) {
    const core::StepReport report = navigator.observe(scan);
    if (report.decisions.empty() && !decided) navigated.before_search += report.associations.size();
    decided = decided || !report.decisions.empty();
    navigated.associations.insert(navigated.associations.end(), report.associations.begin(), report.associations.end());
    for (const core::Decision& decision : report.decisions) {
      const auto* closure = std::get_if<core::ClosureDecision>(&decision);
      navigated.closed += closure != nullptr && closure->accepted;
    }
  });
  navigated.end = navigator.pose().mean;
  return navigated;
}

/// Number of differences among the first `count` associations.
std::size_t different(const Navigated& a, const Navigated& b, std::size_t count) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < count; ++i) {
    different += a.associations[i].landmark != b.associations[i].landmark ||
                 a.associations[i].outcome != b.associations[i].outcome;
  }
  return different;
}

/// Scaling by a power of two loses no digits: mapping must not make a single different choice. (The particles may: a
/// constant keeps their prior regular, and a difference in the ninth digit changes the resampling.)
TEST(Lengths, AWorldAtAnEighthOfItsSizeIsMappedAsItIs) {
  const core::Recording run = sim::simulate(sim::named_scenario("large-loop"), 7301);
  const Navigated original = navigate(run);
  const Navigated small = navigate(scaled(run, 0.125));
  ASSERT_EQ(original.closed, 1);
  ASSERT_GT(original.before_search, 1000u);
  EXPECT_EQ(small.before_search, original.before_search) << "the return is recognised in the same scan";
  EXPECT_EQ(different(original, small, original.before_search), 0u);
  EXPECT_EQ(small.closed, 1);
  EXPECT_LT((8.0 * small.end.position_m() - original.end.position_m()).norm(), 0.1);
}

TEST(Lengths, AWorldAtATenthOfItsSizeClosesLikeTheOriginal) {
  for (const std::uint64_t seed : {7302, 7303}) {
    const core::Recording run = sim::simulate(sim::named_scenario("large-loop-changed"), seed);
    const Navigated original = navigate(run);
    const Navigated small = navigate(scaled(run, 0.1));
    ASSERT_GE(original.closed, 1) << seed;
    EXPECT_EQ(small.closed, original.closed) << seed;
    EXPECT_LT((10.0 * small.end.position_m() - original.end.position_m()).norm(), 0.5) << seed;
    EXPECT_LT(different(original, small, original.associations.size()), original.associations.size() / 50) << seed;
  }
}

TEST(Lengths, OfTheReferenceReachAreTheDefaults) {
  const std::vector<LengthInForce> before = lengths_in_force({});
  const std::vector<LengthInForce> after = lengths_in_force(fit_lengths({}, half_disc(reference_reach_m)));
  const std::vector<LengthInForce> elsewhere = lengths_in_force(fit_lengths({}, half_disc(3.0)));
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].value, after[i].value) << before[i].name;
    EXPECT_NE(before[i].value, elsewhere[i].value) << before[i].name << ": the default is not the table's";
  }
}

TEST(Lengths, ChosenByTheCallerStay) {
  NavigatorOptions options;
  set_length(options, "search.old_after_m", 80.0);
  options = fit_lengths(options, half_disc(3.0));
  EXPECT_EQ(options.search.old_after_m, 80.0);
  EXPECT_DOUBLE_EQ(options.search.rivals.distinct_m, 0.1);
  EXPECT_DOUBLE_EQ(options.search.rivals.extraneous_per_m2, 0.14);
  EXPECT_THROW(set_length(options, "search.old", 1.0), core::PreconditionError);
}

TEST(Lengths, StayWhereNobodyKnowsTheReach) {
  for (const double reach_m : {0.0, -1.0, infinity, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(fit_lengths({}, half_disc(reach_m)).search.reach_m, SearchOptions{}.reach_m) << reach_m;
  }
}

TEST(Lengths, OfANarrowViewLetLandmarksGetOldLater) {
  EXPECT_EQ(fit_lengths({}, {1.0, 30.0, -0.7, 0.7}).search.old_after_m, 120.0);
  EXPECT_EQ(fit_lengths({}, {1.0, 30.0, -1.52, 1.52}).search.old_after_m, 60.0);
  EXPECT_EQ(fit_lengths({}, {1.0, 30.0, -core::pi, core::pi}).search.old_after_m, 60.0);
}

TEST(Lengths, ObjectsInNoMapAreCountedWhereNobodyTellsThem) {
  const core::FieldOfView view{1.0, 3.0, -0.7, 0.7};
  SearchOptions search;
  EXPECT_EQ(with_extraneous_density(search, 0.25, view).extraneous_per_scan, search.extraneous_per_scan);
  search.learn_extraneous = true;
  const SearchOptions learnt = with_extraneous_density(search, 0.25, view);
  EXPECT_EQ(learnt.extraneous_per_scan, 0.25);
  EXPECT_EQ(learnt.relocalizer.sensor.extraneous_per_scan, 0.25);
  EXPECT_DOUBLE_EQ(learnt.rivals.extraneous_per_m2, 0.25 / 5.6);
  EXPECT_GT(with_extraneous_density(search, 0.0, view).extraneous_per_scan, 0.0);
}

/// A landmark two metres ahead of a camera that sees three, and gone a few looks later.
TEST(Lengths, OfANearSensorLeaveRoomForLandmarksThatShouldBeSeen) {
  Navigator navigator{core::PoseGaussian{}};
  core::Scan scan;
  scan.field_of_view = {1.0, 3.0, -0.7, 0.7};
  scan.observations = {core::make_cartesian({2.0, 0.0}, 1e-4 * Eigen::Matrix2d::Identity())};
  navigator.observe(scan);
  ASSERT_EQ(navigator.map().size(), 1u);
  scan.observations.clear();
  core::Odometry step;
  step.T_before_after = {0.05, 0.0, 0.0};
  step.covariance = 1e-6 * Eigen::Matrix3d::Identity();
  for (int i = 0; i < 4; ++i) {
    navigator.move(step);
    navigator.observe(scan);
  }
  EXPECT_TRUE(navigator.map().empty()) << "clutter, expected in view four times and never seen again";
}

}  // namespace
}  // namespace helixnav::supervisor
