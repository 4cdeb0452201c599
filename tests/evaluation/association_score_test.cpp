// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/evaluation/association_score.hpp"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"

namespace helixnav::evaluation {
namespace {

using core::Outcome;
using Labels = std::vector<std::vector<core::Label>>;

core::AssociationReport report(int observation, Outcome outcome, core::LandmarkId landmark) {
  core::AssociationReport association;
  association.observation = observation;
  association.outcome = outcome;
  association.landmark = landmark;
  return association;
}

core::StepReport step(std::int64_t number, std::vector<core::AssociationReport> associations) {
  core::StepReport report;
  report.step = number;
  report.associations = std::move(associations);
  return report;
}

core::MapLandmark mature(core::LandmarkId id) { return {id, {}, 5, core::LandmarkState::mature}; }

TEST(AssociationScore, NamesEveryKindOfMistake) {
  const std::vector<core::StepReport> steps = {
      step(0, {report(0, Outcome::augmented, 0), report(1, Outcome::augmented, 1)}),
      step(1, {report(0, Outcome::matched, 0), report(1, Outcome::matched, 0), report(2, Outcome::matched, 1)}),
      step(2, {report(0, Outcome::ambiguous, 0), report(1, Outcome::augmented, 2), report(2, Outcome::ambiguous, 1)}),
  };
  //                    begun     right, wrong, spurious  missed, missed (begun once more), clutter kept out
  const Labels labels = {{7, 8}, {7, 8, core::no_label}, {7, 8, core::no_label}};
  const AssociationScore score = score_associations(steps, labels, {mature(0), mature(1), mature(2)});
  EXPECT_EQ(score.labelled, 6u);
  EXPECT_EQ(score.right, 1u);
  EXPECT_EQ(score.wrong, 1u);
  EXPECT_EQ(score.missed, 2u);
  EXPECT_EQ(score.spurious, 1u);
  EXPECT_EQ(score.landmarks_with_label, 3u);
  EXPECT_EQ(score.labels_mapped, 2u);
  EXPECT_DOUBLE_EQ(score.landmarks_per_true_one(), 1.5);
  // Landmark 0 holds 7, 7, 8: 3 pairs, 1 right. Labels: 7 and 8 three times each.
  EXPECT_DOUBLE_EQ(score.precision(), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(score.recall(), 1.0 / 6.0);
}

TEST(AssociationScore, CountsALandmarkThatBeganWithClutterAsWhatItIsFirstMatchedWith) {
  const std::vector<core::StepReport> steps = {step(0, {report(0, Outcome::augmented, 0)}),
                                               step(1, {report(0, Outcome::matched, 0)}),
                                               step(2, {report(0, Outcome::matched, 0)})};
  const AssociationScore score = score_associations(steps, {{core::no_label}, {4}, {5}}, {});
  EXPECT_EQ(score.right, 1u);
  EXPECT_EQ(score.wrong, 1u);
  EXPECT_EQ(score.spurious, 0u);
}

TEST(AssociationScore, JoinsThePairsOfMergedLandmarksAndTellsVisitsApart) {
  std::vector<core::StepReport> steps = {
      step(0, {report(0, Outcome::augmented, 0)}), step(1, {report(0, Outcome::matched, 0)}),
      step(500, {report(0, Outcome::augmented, 1)}), step(501, {report(0, Outcome::matched, 1)})};
  const Labels labels(4, {3});
  AssociationScore score = score_associations(steps, labels, {mature(0), mature(1)});
  EXPECT_DOUBLE_EQ(score.recall(), 2.0 / 6.0);
  EXPECT_DOUBLE_EQ(score.recall_in_visit(), 1.0);
  EXPECT_DOUBLE_EQ(score.landmarks_per_true_one(), 2.0);
  steps.back().merged = {{0, 1}};
  score = score_associations(steps, labels, {mature(0)});
  EXPECT_DOUBLE_EQ(score.recall(), 1.0);
  EXPECT_DOUBLE_EQ(score.precision(), 1.0);
  EXPECT_DOUBLE_EQ(score.landmarks_per_true_one(), 1.0);
}

TEST(AssociationScore, EqualsCountingAllPairsOneByOne) {
  core::RandomStream random(5, "score");
  for (int t = 0; t < 50; ++t) {
    std::vector<core::StepReport> steps;
    Labels labels;
    struct Sight {
      core::Label label;
      core::LandmarkId landmark;
    };
    std::vector<Sight> sights;
    for (int s = 0; s < 60; ++s) {
      const auto label = static_cast<core::Label>(random.below(6)) - 1;
      const auto landmark = static_cast<core::LandmarkId>(random.below(4));
      const Outcome outcome = random.bernoulli(0.2) ? Outcome::rejected : Outcome::matched;
      steps.push_back(step(s, {report(0, outcome, landmark)}));
      labels.push_back({label});
      if (label >= 0) sights.push_back({label, outcome == Outcome::matched ? landmark : core::no_landmark});
    }
    std::size_t same_landmark = 0;
    std::size_t same_label = 0;
    std::size_t both = 0;
    for (std::size_t i = 0; i < sights.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const bool landmark = sights[i].landmark == sights[j].landmark && sights[i].landmark != core::no_landmark;
        const bool label = sights[i].label == sights[j].label;
        same_landmark += landmark;
        same_label += label;
        both += landmark && label;
      }
    }
    const AssociationScore score = score_associations(steps, labels, {});
    EXPECT_EQ(score.pairs_on_one_landmark, same_landmark);
    EXPECT_EQ(score.pairs_of_label, same_label);
    EXPECT_EQ(score.pairs_right, both);
    EXPECT_EQ(score.pairs_right_in_visit, both);  // sixty scans are one visit
  }
}

TEST(AssociationScore, OfNothingIsPerfectAndEmpty) {
  const AssociationScore score = score_associations({}, {}, {});
  EXPECT_EQ(score.labelled, 0u);
  EXPECT_DOUBLE_EQ(score.precision(), 1.0);
  EXPECT_DOUBLE_EQ(score.recall(), 1.0);
  EXPECT_TRUE(std::isnan(score.landmarks_per_true_one()));
}

}  // namespace
}  // namespace helixnav::evaluation
