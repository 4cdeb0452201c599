// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/join_sessions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/supervisor/named_navigator.hpp"
#include "helixnav/supervisor/navigator.hpp"
#include "sanitized.hpp"

namespace helixnav::supervisor {
namespace {

using Verdict = core::PlacedDecision::Verdict;

constexpr double reach_m = 15.0;
constexpr double sigma_m = 0.03;

std::vector<Eigen::Vector2d> grove(std::uint64_t seed, int trees) {
  core::RandomStream random(seed, "grove");
  std::vector<Eigen::Vector2d> points_m;
  for (int i = 0; i < trees; ++i) {
    const double x_m = random.uniform(0.0, 120.0);
    points_m.emplace_back(x_m, random.uniform(0.0, 40.0));
  }
  return points_m;
}

/// What a session that began at T_world_session knows of the trees between two values of x, a tenth of which it missed.
/// Tree i of the world is its landmark 2·i.
struct MappedSession {
  core::JointMap map;
  core::Pose2 T_world_session;

  MappedSession(const std::vector<Eigen::Vector2d>& trees_m, double from_m, double to_m, std::uint64_t seed) {
    core::RandomStream random(seed, "session");
    const double x_m = random.uniform(from_m, to_m);
    const double y_m = random.uniform(0.0, 40.0);
    T_world_session = core::Pose2(x_m, y_m, random.uniform(-3.0, 3.0));
    for (std::size_t i = 0; i < trees_m.size(); ++i) {
      const bool missed = random.uniform(0.0, 1.0) < 0.1;
      if (missed || trees_m[i].x() < from_m || trees_m[i].x() > to_m) continue;
      const double dx_m = random.normal(0.0, sigma_m);
      const Eigen::Vector2d error_m(dx_m, random.normal(0.0, sigma_m));
      map.joint.ids.push_back(2 * static_cast<core::LandmarkId>(i));
      map.joint.points_m.push_back(core::transform(core::inverse(T_world_session), trees_m[i]) + error_m);
    }
    const auto n = static_cast<Eigen::Index>(3 + 2 * map.joint.ids.size());
    map.joint.covariance = sigma_m * sigma_m * Eigen::MatrixXd::Identity(n, n);
    map.states.assign(map.joint.ids.size(), core::LandmarkState::mature);
    map.observations.assign(map.joint.ids.size(), 5);
    map.next_name = 1000;
    map.reach_m = reach_m;
  }
};

std::vector<core::JointMap> maps_of(const std::vector<MappedSession>& sessions) {
  std::vector<core::JointMap> maps;
  for (const MappedSession& session : sessions) maps.push_back(session.map);
  return maps;
}

/// Three drives through one grove, each overlapping the next, and one elsewhere.
std::vector<MappedSession> three_and_a_stranger(std::uint64_t seed) {
  const std::vector<Eigen::Vector2d> here_m = grove(seed, 150);
  return {MappedSession(here_m, 0.0, 60.0, 10 * seed + 1), MappedSession(here_m, 35.0, 90.0, 10 * seed + 2),
          MappedSession(here_m, 65.0, 120.0, 10 * seed + 3),
          MappedSession(grove(seed + 500, 150), 0.0, 60.0, 10 * seed + 4)};
}

std::vector<Eigen::Vector2d> points_by_x(const core::JointMap& map) {
  std::vector<Eigen::Vector2d> points_m = map.joint.points_m;
  std::sort(points_m.begin(), points_m.end(),
            [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() < b.x(); });
  return points_m;
}

/// Landmarks of two sessions that share a name although they are different trees.
int wrong_pairs(const JoinedSession& a, const JoinedSession& b) {
  int wrong = 0;
  for (const auto& [own, name] : a.name_of) {
    for (const auto& [other, same] : b.name_of) wrong += name == same && own != other ? 1 : 0;
  }
  return wrong;
}

TEST(JoinSessions, DrivesThatOverlapBecomeOneMapAndStrangersStayApart) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const std::vector<MappedSession> sessions = three_and_a_stranger(seed);
    const JoinedSessions joined = join_sessions(maps_of(sessions));
    ASSERT_EQ(joined.components.size(), 2u) << "seed " << seed;
    EXPECT_EQ(std::count_if(joined.sessions.begin(), joined.sessions.end(),
                            [](const JoinedSession& s) { return s.decision.verdict == Verdict::accepted; }),
              2);
    for (const core::JointMap& component : joined.components) {
      EXPECT_FALSE(component.has_end);
      EXPECT_THROW(Navigator::go_on_in(component), core::PreconditionError);
      EXPECT_THROW(NamedNavigator(component, {}), core::PreconditionError);
    }
    for (const JoinedSession& session : joined.sessions) {
      EXPECT_GE(session.decision.landmarks, session.decision.pairs);
      EXPECT_EQ(session.decision.landmarks > 0, session.decision.questions > 0);
    }
    EXPECT_NE(joined.sessions[3].component, joined.sessions[0].component);
    const core::Pose2 T_world_component =
        core::compose(sessions[0].T_world_session, core::inverse(joined.sessions[0].T_component_session));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(joined.sessions[k].component, joined.sessions[0].component);
      const core::Pose2 error = core::between(sessions[k].T_world_session,
                                              core::compose(T_world_component, joined.sessions[k].T_component_session));
      EXPECT_LT(error.position_m().norm(), 0.15) << "session " << k << " of seed " << seed;
      EXPECT_LT(std::abs(error.heading_rad), 0.004);
      for (std::size_t other = 0; other < k; ++other) {
        EXPECT_EQ(wrong_pairs(joined.sessions[k], joined.sessions[other]), 0) << k << " and " << other;
      }
    }
  }
}

TEST(JoinSessions, TheOrderOfTheSessionsDoesNotMatter) {
  const std::vector<core::JointMap> maps = maps_of(three_and_a_stranger(3));
  const JoinedSessions expected = join_sessions(maps);
  for (const std::vector<std::size_t>& order : {std::vector<std::size_t>{3, 2, 1, 0}, {1, 3, 0, 2}, {2, 0, 3, 1}}) {
    std::vector<core::JointMap> shuffled;
    for (const std::size_t k : order) shuffled.push_back(maps[k]);
    const JoinedSessions joined = join_sessions(shuffled);
    ASSERT_EQ(joined.components.size(), expected.components.size());
    for (std::size_t c = 0; c < expected.components.size(); ++c) {
      const auto expected_m = points_by_x(expected.components[c]);
      const auto found_m = points_by_x(joined.components[c]);
      ASSERT_EQ(found_m.size(), expected_m.size());
      for (std::size_t i = 0; i < found_m.size(); ++i) EXPECT_LT((found_m[i] - expected_m[i]).norm(), 1e-6);
    }
  }
}

/// Largest first, and of those that a session does not reach the next: whatever the order they are named in.
TEST(JoinSessions, FiveSessionsInAll120OrdersAreOneMap) {
  const std::vector<Eigen::Vector2d> trees_m = grove(21, 150);
  std::vector<MappedSession> sessions;
  for (const auto& [from_m, to_m] : {std::pair{0.0, 45.0}, {25.0, 70.0}, {50.0, 95.0}, {75.0, 120.0}, {10.0, 60.0}}) {
    sessions.emplace_back(trees_m, from_m, to_m, 211 + sessions.size());
  }
  const std::vector<core::JointMap> maps = maps_of(sessions);
  const auto expected_m = points_by_x(join_sessions(maps).components.at(0));
  std::vector<std::size_t> order{0, 1, 2, 3, 4};
  int tried = 0;
  do {
    if (support::sanitized && tried++ % 30 != 29) continue;  // four will do to watch the code
    std::vector<core::JointMap> shuffled;
    for (const std::size_t k : order) shuffled.push_back(maps[k]);
    const JoinedSessions joined = join_sessions(shuffled);
    ASSERT_EQ(joined.components.size(), 1u);
    const auto found_m = points_by_x(joined.components[0]);
    ASSERT_EQ(found_m.size(), expected_m.size());
    for (std::size_t i = 0; i < found_m.size(); ++i) ASSERT_LT((found_m[i] - expected_m[i]).norm(), 1e-6);
    for (std::size_t a = 0; a < order.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) ASSERT_EQ(wrong_pairs(joined.sessions[a], joined.sessions[b]), 0);
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(JoinSessions, TakingASessionOutIsJoiningTheOthers) {
  const std::vector<MappedSession> sessions = three_and_a_stranger(4);
  const JoinedSessions joined = join_sessions({sessions[0].map, sessions[2].map});
  EXPECT_EQ(joined.components.size(), 2u) << "the drive that connected them is gone";
}

TEST(JoinSessions, WhatBothSawIsKnownBetterAndCountedOnce) {
  const std::vector<MappedSession> sessions = three_and_a_stranger(5);
  const JoinedSessions joined = join_sessions({sessions[0].map, sessions[1].map});
  ASSERT_EQ(joined.components.size(), 1u);
  const core::JointMap& map = joined.components[0];
  const std::size_t merged =
      static_cast<std::size_t>(std::max(joined.sessions[0].decision.merged, joined.sessions[1].decision.merged));
  EXPECT_GE(merged, 15u);
  EXPECT_EQ(map.joint.ids.size() + merged, sessions[0].map.joint.ids.size() + sessions[1].map.joint.ids.size());
  const auto seen_twice = std::count(map.observations.begin(), map.observations.end(), 10);
  EXPECT_EQ(static_cast<std::size_t>(seen_twice), merged);
}

TEST(JoinSessions, MapsWithoutLandmarksAreComponentsOfTheirOwn) {
  core::JointMap empty;
  empty.joint.covariance = Eigen::Matrix3d::Identity();
  const JoinedSessions joined = join_sessions({empty, three_and_a_stranger(6)[0].map, empty});
  EXPECT_EQ(joined.components.size(), 3u);
  EXPECT_TRUE(join_sessions({}).components.empty());
}

}  // namespace
}  // namespace helixnav::supervisor
