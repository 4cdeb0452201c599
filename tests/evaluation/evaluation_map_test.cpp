// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation_map.hpp"

#include <gtest/gtest.h>

namespace helixnav::evaluation {
namespace {

core::MapLandmark landmark(core::LandmarkId id, double x, double y, int observations = 10) {
  core::MapLandmark result;
  result.id = id;
  result.point.mean_m = {x, y};
  result.observations = observations;
  result.state = core::LandmarkState::mature;
  return result;
}

TEST(MapEvaluation, PairsByDistanceOneToOne) {
  runs::Run run;
  run.map = {landmark(0, 0.1, 0.0), landmark(1, 0.0, 0.2), landmark(2, 10.0, 0.3), landmark(3, 50.0, 0.0)};
  run.map.push_back(landmark(4, 20.0, 0.0));
  run.map.back().state = core::LandmarkState::tentative;  // does not count
  runs::RunTruth truth;
  truth.landmarks = {{7, {0.0, 0.0}}, {8, {10.0, 0.0}}, {9, {20.0, 0.0}}};
  const MapEvaluation map = evaluate_map(run, truth, {}, 2.0);
  EXPECT_FALSE(map.by_label);
  EXPECT_EQ(map.error_m.count, 2u);
  EXPECT_NEAR(map.error_m.rmse, std::sqrt((0.01 + 0.09) / 2.0), 1e-12);
  EXPECT_EQ(map.missing, 1u);
  EXPECT_EQ(map.duplicates, 1u);
  EXPECT_EQ(map.spurious, 1u);
}

/// A radar far from its start: the map says that it is metres off, and its landmarks are farther apart than that.
TEST(MapEvaluation, PairsAsFarAsTheMapIsUncertainButNotWithANeighbour) {
  runs::Run run;
  run.map = {landmark(0, 4.0, 0.0), landmark(1, 24.0, 0.0), landmark(2, 46.0, 0.0)};
  run.map[0].point.covariance_m2 = Eigen::Matrix2d::Identity();
  run.map[0].point.covariance_m2(0, 0) = 2.25;
  run.map[1].point.covariance_m2 = 0.04 * Eigen::Matrix2d::Identity();
  run.map[2].point.covariance_m2 = 100.0 * Eigen::Matrix2d::Identity();
  runs::RunTruth truth;
  truth.landmarks = {{7, {0.0, 0.0}}, {8, {20.0, 0.0}}, {9, {40.0, 0.0}}, {10, {40.0, 11.0}}};
  const MapEvaluation map = evaluate_map(run, truth, {}, 2.0);
  EXPECT_EQ(map.error_m.count, 1u);
  EXPECT_NEAR(map.error_m.max, 4.0, 1e-12);
  EXPECT_EQ(map.spurious, 2u) << "a sharp one 4 m off, and one beyond half-way to the next true one";
}

TEST(MapEvaluation, MovesTheMapIntoTheFrameOfTheTruthFirst) {
  runs::Run run;
  run.map = {landmark(0, 1.0, 2.0)};
  runs::RunTruth truth;
  const core::Pose2 T_truth_map(100.0, 50.0, core::pi / 2);
  truth.landmarks = {{7, {98.0, 51.0}}};
  EXPECT_NEAR(evaluate_map(run, truth, T_truth_map, 2.0).error_m.max, 0.0, 1e-12);
}

TEST(MapEvaluation, PairsByDistanceWhereNoObservationCarriesATrueLabel) {
  runs::Run run;
  run.map = {landmark(0, 0.1, 0.0)};
  run.truth.landmarks = {{7, {0.0, 0.0}}};
  core::StepReport& step = run.steps.emplace_back();
  step.associations = {{0, core::Outcome::matched, 0, 1.0, 2, 1.0}};
  for (const core::Label label : {core::no_label, core::Label{3}}) {
    run.truth.labels = {{label}};
    const MapEvaluation map = evaluate_map(run, run.truth, {}, 2.0);
    EXPECT_FALSE(map.by_label) << label;
    EXPECT_EQ(map.error_m.count, 1u) << label;
  }
  run.truth.labels = {{7}};
  EXPECT_TRUE(evaluate_map(run, run.truth, {}, 2.0).by_label);
}

TEST(MapEvaluation, PairsByLabelWhateverTheDistance) {
  runs::Run run;
  run.map = {landmark(0, 5.0, 0.0, 20), landmark(1, 0.0, 0.5, 12), landmark(2, 9.0, 9.0)};
  run.truth.landmarks = {{7, {0.0, 0.0}}, {8, {30.0, 0.0}}, {9, {60.0, 0.0}}};
  for (int k = 0; k < 12; ++k) {
    core::StepReport& step = run.steps.emplace_back();
    step.step = k;
    step.associations = {{0, core::Outcome::matched, 0, 1.0, 2, 1.0},
                         {1, core::Outcome::matched, 1, 1.0, 2, 1.0},
                         {2, core::Outcome::matched, 2, 1.0, 2, 1.0},
                         {3, core::Outcome::rejected, core::no_landmark, 1.0, 2, 1.0}};
    // Landmarks 0 and 1 are both tree 7 (once mislabelled), 2 is clutter; tree 8 is seen but not mapped, 9 never seen.
    run.truth.labels.push_back({k == 0 ? 8 : 7, 7, core::no_label, 8});
  }
  const MapEvaluation map = evaluate_map(run, run.truth, {}, 2.0);
  EXPECT_TRUE(map.by_label);
  EXPECT_EQ(map.error_m.count, 1u);
  EXPECT_NEAR(map.error_m.rmse, 5.0, 1e-12) << "the landmark with more observations is the partner";
  EXPECT_EQ(map.duplicates, 1u);
  EXPECT_EQ(map.missing, 1u);
  EXPECT_EQ(map.spurious, 1u);
}

/// Far from home an observation may be of trees hundreds of metres apart; none of them is what the landmark is.
TEST(MapEvaluation, TakesNoLabelFromObservationsThatWereNotUsed) {
  runs::Run run;
  run.map = {landmark(0, 0.1, 0.0)};
  run.truth.landmarks = {{7, {0.0, 0.0}}, {8, {200.0, 0.0}}};
  for (int k = 0; k < 20; ++k) {
    core::StepReport& step = run.steps.emplace_back();
    step.step = k;
    step.associations = {{0, k < 3 ? core::Outcome::matched : core::Outcome::ambiguous, 0, 1.0, 2, 1.0}};
    run.truth.labels.push_back({k < 3 ? 7 : 8});
  }
  const MapEvaluation map = evaluate_map(run, run.truth, {}, 2.0);
  EXPECT_TRUE(map.by_label);
  EXPECT_NEAR(map.error_m.max, 0.1, 1e-12);
  EXPECT_EQ(map.missing, 1u) << "tree 8, seen 17 times";
}

/// A map started by others: another robot of the team, or an earlier run.
TEST(MapEvaluation, JudgesLandmarksThatTheRunNeverSawByWhereTheyStand) {
  runs::Run run;
  run.map = {landmark(0, 0.1, 0.0, 20), landmark(1, 30.2, 0.0, 12), landmark(2, 45.0, 0.0, 12)};
  run.truth.landmarks = {{7, {0.0, 0.0}}, {8, {30.0, 0.0}}};
  run.steps.emplace_back().associations = {{0, core::Outcome::matched, 0, 1.0, 2, 1.0}};
  run.truth.labels = {{7}};
  const MapEvaluation map = evaluate_map(run, run.truth, {}, 2.0);
  EXPECT_TRUE(map.by_label);
  EXPECT_EQ(map.error_m.count, 1u);
  EXPECT_EQ(map.spurious, 1u) << "that at 45 m, where none stands";
}

}  // namespace
}  // namespace helixnav::evaluation
