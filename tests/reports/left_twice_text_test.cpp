// SPDX-License-Identifier: BSD-3-Clause
#include "left_twice_text.hpp"

#include <gtest/gtest.h>

namespace helixnav::reports {
namespace {

constexpr std::size_t search_from = 20, step_count = 40;

/// A landmark every 10 m; from the search_from on a search, which is closed in the last step, maps others so far beside the first ones.
runs::Run run_closed(double aside_m) {
  runs::Run run;
  for (std::size_t k = 0; k < step_count; ++k) {
    core::StepReport& step = run.steps.emplace_back();
    step.mode = k < search_from ? core::Mode::mapping : core::Mode::searching;
    core::MapLandmark landmark;
    landmark.id = static_cast<core::LandmarkId>(k);
    landmark.state = core::LandmarkState::mature;
    landmark.point.mean_m = {10.0 * static_cast<double>(k % search_from), k < search_from ? 0.0 : aside_m};
    run.map.push_back(landmark);
    core::AssociationReport began;
    began.outcome = core::Outcome::augmented;
    began.landmark = landmark.id;
    step.associations = {began};
  }
  core::ClosureDecision closure;
  closure.accepted = true;
  run.steps.back().decisions = {closure};
  return run;
}

/// Merged by the closing: on the map once.
void merge_last(runs::Run& run, std::size_t count) { run.map.resize(run.map.size() - count); }

TEST(LeftTwice, IsSaidOfWhatStandsBesideOlderLandmarks) {
  runs::Run run = run_closed(0.8);
  merge_last(run, 15);
  const std::string text = left_twice_text(run);
  EXPECT_NE(text.find("5 landmarks mapped before a loop was closed stand within 0.8 m of older ones"),
            std::string::npos)
      << text;
  merge_last(run, 3);
  EXPECT_TRUE(left_twice_text(run).empty()) << "two may be there by chance";
}

TEST(LeftTwice, IsNotSaidOfOthers) {
  runs::Run apart = run_closed(5.0);
  EXPECT_TRUE(left_twice_text(apart).empty());
  runs::Run open = run_closed(0.8);
  merge_last(open, 15);
  open.steps.back().decisions.clear();
  EXPECT_TRUE(left_twice_text(open).empty()) << "another warning tells of searches that are open";
  EXPECT_TRUE(left_twice_text(runs::Run{}).empty());
}

TEST(LeftTwice, IsNotSaidOfTwoThatWereSeenTogether) {
  runs::Run run = run_closed(0.8);
  merge_last(run, 15);
  for (std::size_t k = search_from; k < search_from + 5; ++k) {
    core::AssociationReport beside;
    beside.outcome = core::Outcome::matched;
    beside.landmark = static_cast<core::LandmarkId>(k - search_from);
    run.steps[k].associations.push_back(beside);
  }
  EXPECT_TRUE(left_twice_text(run).empty());
}

TEST(LeftTwice, SaysHowFarOfThoseThatAreLeftAlone) {
  runs::Run run = run_closed(0.8);
  merge_last(run, 15);
  run.map.back().point.mean_m.y() = 2.0;  // and that one was seen beside its neighbour
  core::AssociationReport beside;
  beside.outcome = core::Outcome::matched;
  beside.landmark = run.map.back().id - static_cast<core::LandmarkId>(search_from);
  run.steps[static_cast<std::size_t>(run.map.back().id)].associations.push_back(beside);
  const std::string text = left_twice_text(run);
  EXPECT_NE(text.find("4 landmarks mapped before a loop was closed stand within 0.8 m"), std::string::npos) << text;
}

}  // namespace
}  // namespace helixnav::reports
