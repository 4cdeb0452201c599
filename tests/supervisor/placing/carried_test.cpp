// SPDX-License-Identifier: BSD-3-Clause
// A vehicle that is said to have been carried away.
#include <algorithm>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "circuits.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/supervisor/named_navigator.hpp"
#include "pauses.hpp"

namespace helixnav::supervisor {
namespace {

using Verdict = core::PlacedDecision::Verdict;

struct Driven {
  std::vector<core::StepReport> reports;
  std::vector<core::CarriedDecision> carried;
  std::vector<core::PlacedDecision> placed;
  std::vector<core::MapLandmark> map;
  std::map<int, core::JointMap> apart;
  double error_at_end_m = 0.0;

  int mature() const {
    return static_cast<int>(std::count_if(map.begin(), map.end(), [](const core::MapLandmark& landmark) {
      return landmark.state == core::LandmarkState::mature;
    }));
  }
};

Driven drive_all(const core::Recording& run) {
  Driven driven;
  Navigator navigator(run.start);
  for (const core::Event& event : run.events) {
    const std::optional<core::StepReport> report = navigator.take(event);
    if (!report) continue;
    driven.reports.push_back(*report);
    for (const core::Decision& decision : report->decisions) {
      if (const auto* carried = std::get_if<core::CarriedDecision>(&decision)) driven.carried.push_back(*carried);
      const auto* placed = std::get_if<core::PlacedDecision>(&decision);
      if (placed != nullptr && placed->verdict == Verdict::accepted) driven.placed.push_back(*placed);
    }
  }
  driven.map = navigator.map();
  driven.apart = navigator.maps_apart();
  const core::Pose2& truth = run.true_poses.back().T_world_robot;
  driven.error_at_end_m = (navigator.pose().mean.position_m() - truth.position_m()).norm();
  return driven;
}

TEST(Carried, FindsItsPlaceAndHasOneMap) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const core::Recording run = with_pauses(sim::simulate(wide_circuit(), seed), {{220, 290}}, true);
    const Driven driven = drive_all(run);
    ASSERT_EQ(driven.carried.size(), 1u);
    EXPECT_EQ(driven.carried[0].part, 1);
    EXPECT_GE(driven.carried[0].landmarks, 22);
    ASSERT_EQ(driven.placed.size(), 1u);
    EXPECT_EQ(driven.placed[0].part, 0);
    EXPECT_LT(driven.error_at_end_m, 0.8);
    EXPECT_GE(driven.mature(), 22);
    EXPECT_LE(driven.mature(), 26) << "25 stand there: one map, not two";
    EXPECT_TRUE(driven.apart.empty());
  }
}

TEST(Carried, NothingMappedBeforeIsMatchedUntilThePlaceIsFound) {
  const core::Recording run = with_pauses(sim::simulate(wide_circuit(), 1), {{220, 290}}, true);
  const Driven driven = drive_all(run);
  core::LandmarkId last = core::no_landmark;
  for (std::size_t k = 0; k < 220; ++k) {
    for (const core::AssociationReport& a : driven.reports[k].associations) last = std::max(last, a.landmark);
  }
  const auto is_placed = [](const core::Decision& decision) {
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    return placed != nullptr && placed->verdict == Verdict::accepted;
  };
  std::size_t between = 0;
  for (std::size_t k = 220; k < driven.reports.size(); ++k, ++between) {
    const core::StepReport& report = driven.reports[k];
    for (const core::AssociationReport& a : report.associations) {
      EXPECT_TRUE(a.landmark == core::no_landmark || a.landmark > last) << "scan " << k;
    }
    if (std::any_of(report.decisions.begin(), report.decisions.end(), is_placed)) break;
  }
  EXPECT_GE(between, 1u);
  EXPECT_LT(between, 100u);
}

/// Set down where it is carried away again at once, and once more before the second part was found.
TEST(Carried, AgainAndAgainKeepsThePartsThatCanBeFound) {
  const core::Recording whole = sim::simulate(wide_circuit(), 4);
  const Driven few = drive_all(with_pauses(whole, {{220, 250}, {252, 290}}, true));
  ASSERT_EQ(few.carried.size(), 2u);
  EXPECT_EQ(few.carried[1].landmarks, 0) << "two scans make no map";
  EXPECT_EQ(few.carried[1].apart, 1);
  ASSERT_EQ(few.placed.size(), 1u);
  EXPECT_EQ(few.placed[0].part, 0);
  EXPECT_LT(few.error_at_end_m, 0.8);
}

TEST(Carried, ToNewGroundKeepsTheMapBeforeApart) {
  core::Recording run = with_pauses(sim::simulate(wide_circuit(), 1), {{220, 400}}, true);
  const core::Recording elsewhere = sim::simulate(wide_circuit(), 9);
  run.events.emplace_back(core::Lost{core::time_of(run.events.back())});
  run.events.insert(run.events.end(), elsewhere.events.begin(), elsewhere.events.begin() + 400);
  const Driven driven = drive_all(run);
  EXPECT_TRUE(driven.placed.empty());
  ASSERT_EQ(driven.apart.count(0), 1u);
  EXPECT_GE(driven.apart.at(0).joint.ids.size(), 22u);
  const core::LandmarkId last = driven.apart.at(0).joint.ids.back();
  for (const core::MapLandmark& landmark : driven.map) EXPECT_GT(landmark.id, last) << "a map of its own";
}

TEST(Carried, ByNameIsRefused) {
  NamedNavigator navigator{core::PoseGaussian{}};
  EXPECT_THROW(navigator.take(core::Lost{}, {}), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::supervisor
