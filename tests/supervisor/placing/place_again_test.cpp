// SPDX-License-Identifier: BSD-3-Clause
// A session that is placed where the map looks like where it began, and that then drives onto the rest of the map.
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/merged_ids.hpp"
#include "placing/displaced_map.hpp"

namespace helixnav::supervisor {
namespace {

struct PlacedAgain {
  std::vector<core::PlacedDecision> placings;
  std::optional<core::CarriedDecision> carried;
  std::size_t placed_at = 0, carried_at = 0;  ///< scans: first placed, and placed again
  std::vector<core::StepReport> steps;
  std::vector<core::MapLandmark> map;
};

PlacedAgain drive_and_place_again(const core::Recording& run, const core::JointMap& earlier) {
  PlacedAgain driven;
  Navigator navigator(core::PoseGaussian{});
  navigator.look_for_place_in(earlier);
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    driven.steps.push_back(navigator.observe(scan));
    for (const core::Decision& decision : driven.steps.back().decisions) {
      const auto* placed = std::get_if<core::PlacedDecision>(&decision);
      const bool is_placing = placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted;
      if (is_placing && driven.placings.empty()) driven.placed_at = i;
      if (is_placing) driven.placings.push_back(*placed);
      if (const auto* carried = std::get_if<core::CarriedDecision>(&decision)) {
        driven.carried = *carried;
        driven.carried_at = i;
      }
    }
  });
  driven.map = navigator.map();
  return driven;
}

TEST(PlaceAgain, APlaceThatLaterLandmarksContradictIsUndone) {
  for (std::uint64_t seed = 7; seed <= 9; ++seed) {
    SCOPED_TRACE(seed);
    const DisplacedMap given = displaced_map(seed);
    const PlacedAgain driven = drive_and_place_again(given.today, given.earlier);
    ASSERT_EQ(driven.placings.size(), 2u);
    ASSERT_TRUE(driven.carried);
    EXPECT_EQ(driven.carried->cause, core::CarriedDecision::Cause::wrong_place);
    EXPECT_EQ(driven.carried->scans, static_cast<int>(driven.carried_at)) << "all scans of the session";
    EXPECT_GT(driven.placings[1].evidence, driven.placings[0].evidence);
    EXPECT_NEAR(driven.placings[1].T_map_session.x_m, -700.0, 5.0) << "from where the first put it";
    const core::Pose2& truth = given.today.true_poses.back().T_world_robot;
    EXPECT_LT((driven.steps.back().pose.mean.position_m() - truth.position_m()).norm(), 2.0);
  }
}

/// Every scan since the first placing is decided again; landmarks merged at the wrong place exist again, and each that is on the map at the
/// end is one thing.
TEST(PlaceAgain, WhatWasReportedMeanwhileIsRevised) {
  const DisplacedMap given = displaced_map(7);
  const PlacedAgain driven = drive_and_place_again(given.today, given.earlier);
  ASSERT_TRUE(driven.carried);
  const std::vector<core::RevisedScan>& revised = driven.steps[driven.carried_at].revised;
  ASSERT_EQ(revised.size(), driven.carried_at - driven.placed_at - 1);
  std::set<core::LandmarkId> on_map;
  for (const core::MapLandmark& landmark : driven.map) on_map.insert(landmark.id);
  const core::MergedIds merged(driven.steps);
  std::map<core::LandmarkId, std::set<core::Label>> labels_of;
  int used = 0, of_map = 0;
  for (std::size_t k = 0; k < revised.size(); ++k) {
    EXPECT_EQ(revised[k].step, static_cast<std::int64_t>(driven.placed_at + 1 + k));
    for (const core::AssociationReport& a : revised[k].associations) {
      if (a.outcome != core::Outcome::matched && a.outcome != core::Outcome::augmented) continue;
      ++used;
      const core::LandmarkId landmark = merged.now(a.landmark);
      if (on_map.count(landmark) == 0) continue;  // it has died since
      ++of_map;
      const std::vector<core::Label>& labels = given.today.labels[static_cast<std::size_t>(revised[k].step)];
      labels_of[landmark].insert(labels[static_cast<std::size_t>(a.observation)]);
    }
  }
  EXPECT_GT(10 * of_map, 9 * used);
  const auto has_one_label = [](const auto& landmark) { return landmark.second.size() == 1; };
  const auto pure = std::count_if(labels_of.begin(), labels_of.end(), has_one_label);
  EXPECT_GT(20 * pure, 19 * static_cast<std::ptrdiff_t>(labels_of.size()));
}

}  // namespace
}  // namespace helixnav::supervisor
