// SPDX-License-Identifier: BSD-3-Clause
// Where places repeat: asked about ground that is not on the map, and about ground that is.
#include "helixnav/relocalize/elsewhere.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "helixnav/core/angle.hpp"
#include "worlds.hpp"

namespace helixnav::relocalize {
namespace {

constexpr IndexOptions street_index = {15.0, 0.1};

/// Streets 50 m apart in both directions with a tree every 8 m on both of their sides, and normal jitter.
test::Points street_world(int streets, double jitter_m, core::RandomStream& random) {
  constexpr double block_m = 50.0;
  constexpr double half_width_m = 5.0;
  test::Points points;
  const auto plant = [&](double x_m, double y_m) {
    const double y_jitter_m =
        jitter_m * random.normal();  // one after the other: the order of arguments is the compiler's
    const double x_jitter_m = jitter_m * random.normal();
    points.emplace_back(x_m + x_jitter_m, y_m + y_jitter_m);
  };
  for (int street = 0; street < streets; ++street)
    for (int block = 0; block + 1 < streets; ++block)
      for (const double side_m : {-half_width_m, half_width_m})
        for (double in_block_m = 8.0; in_block_m < block_m - 7.0; in_block_m += 8.0) {
          plant(block * block_m + in_block_m, street * block_m + side_m);
          plant(street * block_m + side_m, block * block_m + in_block_m);
        }
  return points;
}

constexpr std::size_t in_question = 12;

struct Street {
  std::uint64_t seed;
  int question;  ///< the one among 200 about absent ground that ask() closes
};

class WrongPlaceInAStreet : public testing::TestWithParam<Street> {};

/// Developed on seeds 1 to 10: of 2000 absent places ask() closed 3, of 2000 present ones 1106, and 0 and 1019 where places
/// repeat. Of the seeds 11 to 30, never used before, these are the three with an absent place that ask() closes.
TEST_P(WrongPlaceInAStreet, IsAmbiguousAndTheRightOneIsClosed) {
  core::RandomStream random(GetParam().seed);
  const test::Points world = street_world(5, 0.3, random);
  const test::Points other = street_world(5, 0.3, random);
  const MapIndex map = test::index_of(world, street_index);
  for (int k = 0; k < GetParam().question; ++k) test::ask_somewhere(other, {in_question, 0.1}, random);
  const test::Asked absent = test::ask_somewhere(other, {in_question, 0.1}, random);
  EXPECT_EQ(ask(map, absent.question).verdict, Verdict::closed);
  EXPECT_EQ(ask_where_places_repeat(map, absent.question).verdict, Verdict::ambiguous);
  int closed = 0;
  for (int k = 0; k < 20; ++k) {
    const test::Asked present = test::ask_somewhere(world, {in_question, 0.1}, random);
    const Answer answer = ask_where_places_repeat(map, present.question);
    if (answer.verdict != Verdict::closed) continue;
    EXPECT_FALSE(test::wrong(present, answer.places.front().T_map_branch));
    ++closed;
  }
  EXPECT_GE(closed, 4);  // of 20 with probability 0.5: fewer in 1.3 of 1000 draws
}

INSTANTIATE_TEST_SUITE_P(Elsewhere, WrongPlaceInAStreet,
                         testing::Values(Street{13, 11}, Street{19, 100}, Street{24, 97}));

TEST(Elsewhere, IsNothingWhereLandmarksStandIrregularly) {
  core::RandomStream random(1);
  for (const std::size_t landmarks : {12U, 20U}) {
    const double elsewhere =
        evidence_elsewhere(test::index_of(test::uniform_world(1000, random), {30.0, 0.1}), landmarks);
    EXPECT_LT(elsewhere, 3.0) << landmarks;
  }
}

TEST(Elsewhere, ConstellationsThatStandTwiceAreLeftToTheLead) {
  core::RandomStream random(1);
  test::Points world = test::uniform_world(200, random);
  for (std::size_t i = 0; i < 200; ++i) world.push_back(world[i] + Eigen::Vector2d(400.0, 50.0));
  const MapIndex map = test::index_of(world, {30.0, 0.1});
  EXPECT_LT(evidence_elsewhere(map, in_question), 3.0);
  const test::Asked asked = test::ask_somewhere(world, {in_question, 0.0}, random);
  EXPECT_EQ(ask_where_places_repeat(map, asked.question).verdict, Verdict::ambiguous);
}

TEST(Elsewhere, DoesNotDependOnTheOrderInWhichTheMapWasMade) {
  core::RandomStream random(1);
  const test::Points world = street_world(4, 0.3, random);
  MapIndex grown(street_index);
  auto landmarks = test::landmarks(world, street_index.pair_noise_m);
  std::reverse(landmarks.begin(), landmarks.end());
  for (const Landmark& landmark : landmarks) grown.insert(landmark);
  grown.erase(0);
  grown.insert(landmarks.back());
  grown.look_around_landmarks();
  const double built = evidence_elsewhere(test::index_of(world, street_index), in_question);
  EXPECT_GT(built, 10.0);
  EXPECT_NEAR(evidence_elsewhere(grown, in_question), built, 1e-4);
}

// Known to 0.05 m across and 300 m along some direction: in single precision some of them are not positive definite.
TEST(Elsewhere, TakesLandmarksThatAreHardlyKnownInOneDirection) {
  core::RandomStream random(1);
  auto landmarks = test::landmarks(street_world(4, 0.3, random), street_index.pair_noise_m);
  for (Landmark& landmark : landmarks) {
    const double angle_rad = random.uniform(0.0, core::pi);
    const Eigen::Vector2d along_m = 300.0 * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad));
    landmark.point.covariance_m2 = along_m * along_m.transpose() + 0.0025 * Eigen::Matrix2d::Identity();
  }
  MapIndex map(street_index, landmarks);
  map.look_around_landmarks();
  EXPECT_NO_THROW(evidence_elsewhere(map, in_question));
}

TEST(Elsewhere, IsMinusInfinityForTheSmallestMaps) {
  EXPECT_EQ(evidence_elsewhere(MapIndex(street_index), 12), -std::numeric_limits<double>::infinity());
  const MapIndex one = test::index_of({Eigen::Vector2d(1.0, 2.0)}, street_index);
  EXPECT_EQ(evidence_elsewhere(one, 12), -std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace helixnav::relocalize
