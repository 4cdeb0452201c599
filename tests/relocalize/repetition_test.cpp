// SPDX-License-Identifier: BSD-3-Clause
// What a row of equal spacing says twice, and that an answer which rests on it alone is not believed.
#include "helixnav/relocalize/repetition.hpp"

#include <gtest/gtest.h>

#include "helixnav/relocalize/elsewhere.hpp"
#include "worlds.hpp"

namespace helixnav::relocalize {
namespace {

test::Points row_of_posts(int count, double spacing_m, const core::Pose2& T_world_row) {
  test::Points posts;
  for (int i = 0; i < count; ++i) posts.push_back(core::transform(T_world_row, {spacing_m * i, 0.0}));
  return posts;
}

TEST(IndependentShare, OfARowIsWhatItsFirstTwoPointsSay) {
  EXPECT_DOUBLE_EQ(independent_share(row_of_posts(10, 0.5, {3.0, 1.0, 0.7}), 0.3), 0.2);
  EXPECT_DOUBLE_EQ(independent_share(row_of_posts(10, 0.5, {3.0, 1.0, 0.7}), 1e-9), 0.2) << "any tolerance";
}

TEST(IndependentShare, IsOneWhereNoTwoWaysAreAlike) {
  EXPECT_DOUBLE_EQ(independent_share({{0.0, 0.0}, {1.0, 0.0}, {0.0, 3.0}, {7.0, 7.0}}, 0.3), 1.0);
  EXPECT_DOUBLE_EQ(independent_share({{0.0, 0.0}, {1.0, 0.0}}, 0.3), 1.0);
  EXPECT_DOUBLE_EQ(independent_share({{5.0, 5.0}}, 0.3), 1.0);
  EXPECT_DOUBLE_EQ(independent_share({}, 0.3), 1.0);
}

TEST(IndependentShare, OfIrregularLandmarksIsNearlyAll) {
  core::RandomStream random(1);
  EXPECT_GE(independent_share(test::uniform_world(20, random), 0.3), 0.9);
}

TEST(IndependentShare, CountsWhatARowIsMixedWith) {
  test::Points points = row_of_posts(6, 0.5, {});
  for (const Eigen::Vector2d& other : {Eigen::Vector2d(4.0, 7.0), {9.3, -3.1}, {-6.2, 5.5}, {1.7, -8.8}}) {
    points.push_back(other);
  }
  EXPECT_DOUBLE_EQ(independent_share(points, 0.3), 0.6);  // five of ten repeat
}

/// A row of twelve posts, every half a metre to 3 cm.
test::Points fence(const core::Pose2& T_world_row, core::RandomStream& random) {
  test::Points posts = row_of_posts(12, 0.5, T_world_row);
  for (Eigen::Vector2d& post_m : posts) {
    post_m.x() += 0.03 * random.normal();
    post_m.y() += 0.03 * random.normal();
  }
  return posts;
}

/// The map has one fence among trees, the question is about another one, elsewhere, beside two trees.
TEST(IndependentShare, AFenceElsewhereOfTheSameSpacingIsNotThePlace) {
  const IndexOptions lengths{25.0, 0.125};
  int closed = 0, believed = 0;
  for (std::uint64_t seed = 1; seed <= 600; ++seed) {
    core::RandomStream random(seed);
    test::Points world = fence({40.0, 60.0, 0.4}, random);
    for (int i = 0; i < 30; ++i) {
      const double x_m = random.uniform(0.0, 120.0);
      world.emplace_back(x_m, random.uniform(0.0, 120.0));
    }
    const MapIndex map = test::index_of(world, lengths);
    test::Points seen = fence({2.0, 1.0, -1.0}, random);
    seen.emplace_back(8.0, 2.0);
    seen.emplace_back(-3.0, -4.0);
    Question question;
    question.landmarks = test::landmarks(seen, lengths.pair_noise_m);
    question.looked.push_back({{3.0, -1.0}, 8.0});
    const Answer answer = ask(map, question);
    closed += answer.verdict == Verdict::closed ? 1 : 0;
    believed += ask_where_places_repeat(map, question).verdict == Verdict::closed ? 1 : 0;
  }
  EXPECT_GE(closed, 3) << "or this proves nothing";
  EXPECT_EQ(believed, 0);
}

}  // namespace
}  // namespace helixnav::relocalize
