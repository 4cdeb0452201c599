// SPDX-License-Identifier: BSD-3-Clause
#include "open_searches.hpp"

#include <gtest/gtest.h>

namespace helixnav::reports {
namespace {

constexpr std::size_t turn = 20, steps = 40;

/// A drive of 1 m a step and a landmark a step; from the 20th step on it searches, and what it maps is `aside_m` beside what
/// it mapped before.
runs::Run searching_run(double aside_m) {
  runs::Run run;
  for (std::size_t k = 0; k < steps; ++k) {
    core::StepReport& step = run.steps.emplace_back();
    step.t_ns = static_cast<core::Nanoseconds>(k) * 1'000'000'000;
    step.pose.mean = core::Pose2(static_cast<double>(k), 0.0, 0.0);
    step.mode = k < turn ? core::Mode::mapping : core::Mode::searching;
    core::MapLandmark landmark;
    landmark.id = static_cast<core::LandmarkId>(k);
    landmark.state = core::LandmarkState::mature;
    landmark.point.mean_m = {static_cast<double>(k % turn), k < turn ? 0.0 : aside_m};
    landmark.point.covariance_m2 = 0.01 * Eigen::Matrix2d::Identity();
    run.map.push_back(landmark);
    core::AssociationReport began;
    began.outcome = core::Outcome::augmented;
    began.landmark = landmark.id;
    step.associations = {began};
  }
  return run;
}

runs::Run ended(runs::Run run, const core::Decision& decision) {
  run.steps[steps - 2].decisions = {decision};
  run.steps.back().mode = core::Mode::mapping;
  return run;
}

TEST(OpenSearches, AreSaidWhereOneIsOpenAtTheEnd) {
  const std::string text = open_search_text(searching_run(50.0));
  EXPECT_NE(text.find("still open at the end (19 m, from 20 s on)"), std::string::npos) << text;
  EXPECT_NE(text.find("20 landmarks mapped since may be on the map twice."), std::string::npos) << text;
  EXPECT_NE(open_search_text(searching_run(0.1)).find("20 of them stand where old ones do"), std::string::npos);
}

TEST(OpenSearches, AreSaidBrieflyWhereNothingWasMappedSince) {
  runs::Run run = searching_run(50.0);
  run.map.resize(turn);
  const std::string text = open_search_text(run);
  EXPECT_NE(text.find("still open at the end (19 m, from 20 s on): where"), std::string::npos) << text;
  EXPECT_EQ(text.find("twice"), std::string::npos) << text;
  run.steps[turn].mode = core::Mode::mapping;  // open for 19 scans only
  EXPECT_TRUE(open_search_text(run).empty());
  run.steps[turn + 1].decisions = {core::RollbackDecision{}};  // but the pose had been wrong for longer
  EXPECT_NE(open_search_text(run).find("still open"), std::string::npos);
}

TEST(OpenSearches, AreSaidWhereTheLastEndedUndecided) {
  runs::Run run = ended(searching_run(50.0), core::UndecidedDecision{});
  EXPECT_NE(open_search_text(run).find("ended undecided"), std::string::npos) << open_search_text(run);
  core::ClosureDecision closed;
  closed.accepted = true;
  run.steps.back().decisions = {closed};
  EXPECT_TRUE(open_search_text(run).empty());
}

/// Everything vanished where the search began; it ended undecided, and the last step closes a loop.
runs::Run lost_run(core::LandmarkId merged_with) {
  runs::Run run = ended(searching_run(50.0), core::UndecidedDecision{});
  run.steps[turn].decisions = {core::LostBySlipDecision{}};
  core::ClosureDecision closed;
  closed.accepted = true;
  run.steps.back().decisions = {closed};
  run.steps.back().merged = {{merged_with, static_cast<core::LandmarkId>(steps - 1)}};
  return run;
}

/// It was silent before: a carried vehicle that closes loops in its own copies of the map is as lost as before.
TEST(OpenSearches, OfALostVehicleAreNotDecidedByALoopInWhatItMappedSince) {
  const std::string text = open_search_text(lost_run(turn + 5));
  EXPECT_NE(text.find("everything in view vanished at 20 s"), std::string::npos) << text;
  EXPECT_NE(text.find("20 landmarks mapped since"), std::string::npos) << text;
  EXPECT_TRUE(open_search_text(lost_run(turn - 5)).empty()) << "closed with what was known before";
}

TEST(OpenSearches, OfALostVehicleAreOverWhenItSeesEnoughOfWhatWasKnown) {
  runs::Run run = lost_run(turn + 5);
  core::AssociationReport known;
  known.outcome = core::Outcome::matched;
  for (known.landmark = 0; known.landmark < 5; ++known.landmark) run.steps.back().associations.push_back(known);
  EXPECT_TRUE(open_search_text(run).empty()) << open_search_text(run);
}

TEST(OpenSearches, DoubtNewGroundOnlyWhereOldLandmarksStand) {
  const std::string doubted = open_search_text(ended(searching_run(0.1), core::NewGroundDecision{}));
  EXPECT_NE(doubted.find("as on new ground"), std::string::npos) << doubted;
  EXPECT_TRUE(open_search_text(ended(searching_run(50.0), core::NewGroundDecision{})).empty());
}

TEST(OpenSearches, AreSaidBrieflyOfWhoOnlyLocalises) {
  runs::Run run = searching_run(0.1);
  run.manifest.command = "helixnav replay log --map monday --localize";
  EXPECT_NE(open_search_text(run).find("still open"), std::string::npos);
  EXPECT_EQ(open_search_text(run).find("twice"), std::string::npos) << open_search_text(run);
  EXPECT_TRUE(open_search_text(ended(run, core::UndecidedDecision{})).empty());
}

}  // namespace
}  // namespace helixnav::reports
