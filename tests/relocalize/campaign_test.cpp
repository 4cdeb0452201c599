// SPDX-License-Identifier: BSD-3-Clause
//
// Small campaigns of one seed each; docs/relocalize.md has the large ones.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "worlds.hpp"

namespace helixnav::relocalize {
namespace {

constexpr IndexOptions campaign_index = {30.0, 0.1};

struct Tally {
  int right = 0, wrong = 0, ambiguous = 0;
};

Tally campaign(const test::Points& map, const test::Points& asked_world, const test::Asking& asking, int questions,
               std::uint64_t seed) {
  const bool absent = &map != &asked_world;
  const MapIndex index = test::index_of(map, campaign_index);
  Tally tally;
  for (int q = 0; q < questions; ++q) {
    core::RandomStream random(seed, "question " + std::to_string(q));
    const test::Asked asked = test::ask_somewhere(asked_world, asking, random);
    const Answer answer = ask(index, asked.question);
    tally.ambiguous += answer.verdict == Verdict::ambiguous ? 1 : 0;
    if (answer.verdict != Verdict::closed) continue;
    const bool wrong = absent || test::wrong(asked, answer.places.front().T_map_branch);
    ++(wrong ? tally.wrong : tally.right);
  }
  return tally;
}

TEST(Campaign, AcceptsNoneOfFourHundredAbsentPlaces) {
  core::RandomStream random(11);
  const test::Points map = test::uniform_world(2000, random);
  const test::Points elsewhere = test::uniform_world(2000, random);
  for (const std::size_t n : {10U, 20U}) EXPECT_EQ(campaign(map, elsewhere, {n}, 200, 11).wrong, 0);
}

TEST(Campaign, ClosesTwentyLandmarksAtThirtyPercentChangeAndTenAtNone) {
  core::RandomStream random(12);
  const test::Points map = test::uniform_world(2000, random);
  // 0.99 of 100 are required: fewer than 94 have a probability below 1e-4.
  const Tally changed = campaign(map, map, {20, 0.3}, 100, 12);
  EXPECT_GE(changed.right, 94);
  EXPECT_EQ(changed.wrong, 0);
  const Tally few = campaign(map, map, {10}, 100, 13);
  EXPECT_GE(few.right, 97);
  EXPECT_EQ(few.wrong, 0);
}

double best_evidence(const MapIndex& index, const test::Points& world, const test::Asking& asking, int question) {
  core::RandomStream random(16, "question " + std::to_string(question));
  const Answer answer = ask(index, test::ask_somewhere(world, asking, random).question);
  return answer.places.empty() ? -1e9 : answer.places.front().evidence;
}

/// Evidence is a ratio of two likelihoods, so what is present tells how rare it is where nothing is: the threshold that
/// evidence_needed() takes from its density leaves no more than α, and the tail that can be counted is as it should be.
TEST(Campaign, EvidenceOfWhatIsAbsentIsAsRareAsWhatIsPresentSays) {
  core::RandomStream random(16);
  const test::Points map = test::uniform_world(2000, random);
  const test::Points elsewhere = test::uniform_world(2000, random);
  const MapIndex index = test::index_of(map, campaign_index);
  constexpr int questions = 800;
  for (const test::Asking& asking : {test::Asking{10, 0.3}, test::Asking{10, 0.5}, test::Asking{20, 0.5}}) {
    double accepted = 0.0, expected = 0.0;
    int counted = 0;
    for (int q = 0; q < questions; ++q) {
      const double present = best_evidence(index, map, asking, q);
      if (present >= 0.0) expected += std::exp(-present);
      if (present >= evidence_needed({})) accepted += std::exp(-present) / questions;
      counted += best_evidence(index, elsewhere, asking, questions + q) >= 0.0 ? 1 : 0;
    }
    EXPECT_LT(accepted, AskOptions{}.alpha) << asking.landmarks << ", " << asking.change;
    // Fewer are counted, since candidates with a poor start are not followed; more have a probability below 1e-4.
    EXPECT_LT(counted, expected + 4.0 * std::sqrt(expected) + 4.0) << asking.landmarks << ", " << asking.change;
  }
}

TEST(Campaign, ClosesNothingInALattice) {
  for (const bool hexagonal : {false, true}) {
    core::RandomStream random(14);
    const test::Points map = test::orchard(400, hexagonal, 0.0, random);
    const Tally present = campaign(map, map, {20}, 5, 14);
    EXPECT_EQ(present.right + present.wrong, 0);
    EXPECT_EQ(present.ambiguous, 5);
    const test::Points elsewhere = test::orchard(400, hexagonal, 0.1, random);
    EXPECT_EQ(campaign(map, elsewhere, {20}, 5, 15).wrong, 0);
  }
}

/// Rows of trees, one of which the map holds, queried with landmarks that agree to 0.03 m where 0.3 m is assumed.
Tally ask_among_rows(const test::Points& map, const test::Points& world, std::uint64_t seed) {
  constexpr double assumed_m = 0.3;
  const MapIndex index = test::index_of(map, {30.0, assumed_m});
  Tally tally;
  for (int q = 0; q < 20; ++q) {
    core::RandomStream random(seed, "question " + std::to_string(q));
    test::Asked asked = test::ask_somewhere(world, {30, 0.1, 0.0, 0.03}, random);
    for (Landmark& landmark : asked.question.landmarks)
      landmark.point.covariance_m2 = 0.5 * assumed_m * assumed_m * Eigen::Matrix2d::Identity();
    const Answer answer = ask(index, asked.question);
    tally.ambiguous += answer.verdict == Verdict::ambiguous ? 1 : 0;
    if (answer.verdict != Verdict::closed) continue;
    const bool is_wrong = &map != &world || test::wrong(asked, answer.places.front().T_map_branch);
    ++(is_wrong ? tally.wrong : tally.right);
  }
  return tally;
}

/// Hundreds of places fit to within the jitter of the trees, but only one to within the difference of two sessions.
TEST(Campaign, TellsAPlaceFromRivalsThatFitTenTimesWorse) {
  core::RandomStream random(18);
  const test::Points map = test::orchard(400, false, 0.3, random);
  const Tally present = ask_among_rows(map, map, 18);
  EXPECT_GE(present.right, 15);
  EXPECT_EQ(present.wrong, 0);
  const Tally absent = ask_among_rows(map, test::orchard(400, false, 0.3, random), 19);
  EXPECT_EQ(absent.wrong, 0);
  EXPECT_GE(absent.ambiguous, 10) << "each fits like the others";
  const Tally lattice = ask_among_rows(test::orchard(400, false, 0.0, random), map, 20);
  EXPECT_EQ(lattice.wrong, 0);
}

}  // namespace
}  // namespace helixnav::relocalize
