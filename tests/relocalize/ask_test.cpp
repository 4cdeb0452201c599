// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/relocalize/ask.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "helixnav/core/errors.hpp"
#include "worlds.hpp"

namespace helixnav::relocalize {
namespace {

constexpr IndexOptions ask_index = {30.0, 0.1};

test::Points world_of(std::uint64_t seed, std::size_t count = 1000) {
  core::RandomStream random(seed);
  return test::uniform_world(count, random);
}

void expect_same(const Answer& a, const Answer& b, double tolerance) {
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_NEAR(a.gap, b.gap, tolerance);
  ASSERT_EQ(a.places.size(), b.places.size());
  for (std::size_t i = 0; i < a.places.size(); ++i) {
    EXPECT_NEAR(a.places[i].evidence, b.places[i].evidence, tolerance);
    EXPECT_LE((a.places[i].T_map_branch.vector() - b.places[i].T_map_branch.vector()).norm(), tolerance);
    ASSERT_EQ(a.places[i].pairs.size(), b.places[i].pairs.size());
    for (std::size_t k = 0; k < a.places[i].pairs.size(); ++k) {
      EXPECT_EQ(a.places[i].pairs[k].branch, b.places[i].pairs[k].branch);
      EXPECT_EQ(a.places[i].pairs[k].map, b.places[i].pairs[k].map);
    }
  }
}

TEST(Ask, FindsThePlaceItsPairsAndTheirNoise) {
  const test::Points world = world_of(1);
  core::RandomStream random(1);
  const test::Asked asked = test::ask_somewhere(world, {20, 0.3}, random);
  const Answer answer = ask(test::index_of(world, ask_index), asked.question);
  ASSERT_EQ(answer.verdict, Verdict::closed);
  const Place& best = answer.places.front();
  EXPECT_FALSE(test::wrong(asked, best.T_map_branch));
  EXPECT_GE(best.pairs.size(), 12U);
  for (const Pair& pair : best.pairs) EXPECT_EQ(asked.truth[static_cast<std::size_t>(pair.branch)], pair.map);
  const Eigen::Vector3d off = best.T_map_branch.vector() - asked.T_map_branch.vector();
  EXPECT_LT(off.dot(best.information * off), 16.3);  // 99.9 % of χ² with three degrees of freedom
}

TEST(Ask, AnswersTheSameAgainAndFromAnIndexThatGrewInAnotherOrder) {
  const test::Points world = world_of(2);
  core::RandomStream random(2);
  const test::Asked asked = test::ask_somewhere(world, {15, 0.4}, random);
  const MapIndex index = test::index_of(world, ask_index);
  const Answer answer = ask(index, asked.question);
  expect_same(answer, ask(index, asked.question), 0.0);
  MapIndex grown(ask_index);
  auto landmarks = test::landmarks(world, ask_index.pair_noise_m);
  std::reverse(landmarks.begin(), landmarks.end());
  for (const Landmark& landmark : landmarks) grown.insert(landmark);
  for (int id = 0; id < 1000; id += 7) {
    Landmark away = landmarks[static_cast<std::size_t>(999 - id)];
    away.point.mean_m.x() += 3.0;
    grown.move(away);
    grown.move(landmarks[static_cast<std::size_t>(999 - id)]);
  }
  grown.look_around_landmarks();
  expect_same(answer, ask(grown, asked.question), 1e-6);
}

TEST(Ask, DoesNotDependOnTheFrameOfTheBranch) {
  const test::Points world = world_of(3);
  core::RandomStream random(3);
  const test::Asked asked = test::ask_somewhere(world, {20, 0.3}, random);
  Question moved = asked.question;
  const core::Pose2 T_new_branch(40.0, -7.0, 2.2);
  for (Landmark& landmark : moved.landmarks)
    landmark.point.mean_m = core::transform(T_new_branch, landmark.point.mean_m);
  for (Disc& disc : moved.looked) disc.centre_m = core::transform(T_new_branch, disc.centre_m);
  const MapIndex index = test::index_of(world, ask_index);
  const Place there = ask(index, moved).places.front();
  const Place here = ask(index, asked.question).places.front();
  EXPECT_NEAR(there.evidence, here.evidence, 1e-3);
  const core::Pose2 back = core::compose(there.T_map_branch, T_new_branch);
  EXPECT_LT((back.vector() - here.T_map_branch.vector()).norm(), 1e-2);  // float coordinates over a lever arm of 700 m
}

TEST(Ask, DoubtsAPlaceThatTheMapHasTwiceUntilOneIsTakenOut) {
  const test::Points once = world_of(4, 150);
  auto landmarks = test::landmarks(once, ask_index.pair_noise_m);
  for (std::size_t i = 0; i < 150; ++i)
    landmarks.push_back(test::landmark(static_cast<int>(150 + i), once[i] + Eigen::Vector2d(400.0, 30.0), 0.07));
  MapIndex index(ask_index, landmarks);
  index.look_around_landmarks();
  core::RandomStream random(4);
  const test::Asked asked = test::ask_somewhere(once, {20, 0.1}, random);
  const Answer doubtful = ask(index, asked.question);
  EXPECT_EQ(doubtful.verdict, Verdict::ambiguous);
  ASSERT_GE(doubtful.places.size(), 2U);
  EXPECT_NEAR((doubtful.places[0].T_map_branch.position_m() - doubtful.places[1].T_map_branch.position_m()).norm(),
              std::hypot(400.0, 30.0), 1.0);
  for (int id = 150; id < 300; ++id) index.erase(id);
  const Answer sure = ask(index, asked.question);
  EXPECT_EQ(sure.verdict, Verdict::closed);
  EXPECT_FALSE(test::wrong(asked, sure.places.front().T_map_branch));
}

TEST(Ask, DoubtsWhatASearchCutShortHasFound) {
  const test::Points world = world_of(5);
  core::RandomStream random(5);
  const test::Asked asked = test::ask_somewhere(world, {20, 0.0}, random);
  const MapIndex index = test::index_of(world, ask_index);
  AskOptions capped;
  capped.most_candidates = 200.0;
  const Answer answer = ask(index, asked.question, capped);
  EXPECT_TRUE(answer.capped);
  EXPECT_LT(answer.triangles, 100U);
  EXPECT_NE(answer.verdict, Verdict::closed);
  EXPECT_EQ(ask(index, asked.question).verdict, Verdict::closed);
}

TEST(Ask, UsesALongAndThinCovarianceWhereARoundOneMisleads) {
  // The branch knows its landmarks to 0.5 m along its way and 3 cm across: true pairs are within the one, not the other.
  const test::Points world = world_of(6);
  core::RandomStream random(6);
  test::Asked asked = test::ask_somewhere(world, {20, 0.0, 0.0, 0.03}, random);
  for (Landmark& landmark : asked.question.landmarks) {
    landmark.point.mean_m.x() += 0.2 * random.normal();
    landmark.point.covariance_m2 << 0.04, 0.0, 0.0, 0.001;
  }
  const MapIndex index = test::index_of(world, ask_index);
  const Answer thin = ask(index, asked.question);
  for (Landmark& landmark : asked.question.landmarks)
    landmark.point.covariance_m2 = 0.001 * Eigen::Matrix2d::Identity();
  const Answer round = ask(index, asked.question);
  EXPECT_EQ(thin.verdict, Verdict::closed);
  EXPECT_FALSE(test::wrong(asked, thin.places.front().T_map_branch));
  EXPECT_GE(thin.places.front().pairs.size(), 16U);
  EXPECT_TRUE(round.places.empty() || round.places.front().evidence < thin.places.front().evidence - 10.0);
}

TEST(Ask, SaysNotHereForTooLittle) {
  const test::Points world = world_of(7);
  const MapIndex index = test::index_of(world, ask_index);
  EXPECT_EQ(ask(index, Question()).verdict, Verdict::not_here);
  core::RandomStream random(7);
  Question three = test::ask_somewhere(world, {3}, random).question;
  EXPECT_EQ(ask(index, three).verdict, Verdict::not_here);
  EXPECT_EQ(ask(MapIndex(ask_index), three).verdict, Verdict::not_here);
  MapIndex one(ask_index);
  one.insert(test::landmark(0, {0.0, 0.0}, 0.1));
  one.look_at({{0.0, 0.0}, 20.0});
  EXPECT_EQ(ask(one, test::ask_somewhere(world, {10}, random).question).verdict, Verdict::not_here);
}

TEST(Ask, RefusesAQuestionThatMakesNoSense) {
  const test::Points world = world_of(8, 100);
  const MapIndex index = test::index_of(world, ask_index);
  core::RandomStream random(8);
  const Question good = test::ask_somewhere(world, {10}, random).question;
  EXPECT_THROW(ask(index, good, {0.0}), core::PreconditionError);
  EXPECT_THROW(ask(index, good, {1.0}), core::PreconditionError);
  EXPECT_THROW(ask(MapIndex(ask_index, test::landmarks(world, 0.1)), good), core::PreconditionError);
  Question bad = good;
  bad.looked.clear();
  EXPECT_THROW(ask(index, bad), core::PreconditionError);
  bad = good;
  bad.looked[0].radius_m = 0.0;
  EXPECT_THROW(ask(index, bad), core::PreconditionError);
  bad = good;
  bad.landmarks[2].point.mean_m.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(ask(index, bad), core::PreconditionError);
  bad = good;
  bad.landmarks[2].point.covariance_m2.setZero();
  EXPECT_THROW(ask(index, bad), core::PreconditionError);
  bad = good;
  bad.prior = Prior();
  EXPECT_THROW(ask(index, bad), core::PreconditionError);  // its covariance is zero
}

}  // namespace
}  // namespace helixnav::relocalize
