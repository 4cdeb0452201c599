// SPDX-License-Identifier: BSD-3-Clause
#include "join/session_changes.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"
#include "join/joined_page.hpp"
#include "join/joined_warnings.hpp"

namespace helixnav::apps {
namespace {

/// A joined map of two sessions: trees on a perturbed 5 m grid, present in both except for what a test takes out or adds.
class TwoSessions {
 public:
  TwoSessions() {
    core::RandomStream random(4, "two sessions");
    for (int k = 0; k < 100; ++k) {
      const double x_m = 5.0 * (k % 10) + random.uniform(-1.0, 1.0);
      add({x_m, 5.0 * (k / 10) + random.uniform(-1.0, 1.0)}, true, true);
    }
  }

  core::LandmarkId add(const Eigen::Vector2d& at_m, bool first, bool second) {
    const core::LandmarkId id = map_.next_name++;
    map_.joint.ids.push_back(id);
    map_.joint.points_m.push_back(at_m);
    map_.states.push_back(core::LandmarkState::mature);
    map_.observations.push_back(5);
    if (first) sessions_[0].name_of[id] = id;
    if (second) sessions_[1].name_of[id] = id;
    return id;
  }
  void was_seen(core::LandmarkId id, int times) { map_.observations[static_cast<std::size_t>(id)] = times; }
  void take_out(core::LandmarkId id, std::size_t session) { sessions_[session].name_of.erase(id); }
  Eigen::Vector2d place_m(core::LandmarkId id) const { return map_.joint.points_m[static_cast<std::size_t>(id)]; }

  supervisor::JoinedSessions joined() const {
    supervisor::JoinedSessions joined;
    joined.sessions = {sessions_[0], sessions_[1]};
    joined.components = {map_};
    const auto rows = 3 + 2 * static_cast<Eigen::Index>(map_.joint.ids.size());
    joined.components.front().joint.covariance = 1e-4 * Eigen::MatrixXd::Identity(rows, rows);
    return joined;
  }
  std::vector<ChangedLandmark> changes(const std::vector<std::optional<SessionViews>>& views = {}) const {
    core::JointMap map = map_;
    map.reach_m = 20.0;
    return shared_landmarks({map, map}, joined(), views);
  }

  /// Of a session that drove around all trees, 4 m outside, and saw everything of its own within reach.
  SessionViews views_of(std::size_t session, double reach_m) const {
    std::vector<Look> looks;
    for (int k = 0; k < 200; ++k) {
      const double along_m = 53.0 * (k % 50) / 50.0 - 4.0;
      const bool rises = k / 50 % 2 == 1;
      const double across_m = k / 50 == 1 || k / 50 == 2 ? 49.0 : -4.0;
      looks.push_back({{rises ? across_m : along_m, rises ? along_m : across_m, 0.0}, {}});
      for (const auto& [own, name] : sessions_[session].name_of) {
        if ((place_m(name) - looks.back().T_map_robot.position_m()).norm() < reach_m) looks.back().seen.push_back(own);
      }
    }
    return {looks, map_};
  }
  Change of(core::LandmarkId id) const {
    const std::vector<ChangedLandmark> all = changes();
    return std::find_if(all.begin(), all.end(), [&](const ChangedLandmark& one) { return one.id == id; })->change();
  }

 private:
  core::JointMap map_;
  supervisor::JoinedSession sessions_[2];
};

TEST(SessionChanges, GoneAndNewFarFromEachOtherAreThat) {
  TwoSessions world;
  world.take_out(44, 1);
  const core::LandmarkId grown = world.add({12.5, 12.5}, false, true);
  EXPECT_EQ(world.of(44), Change::gone);
  EXPECT_EQ(world.of(grown), Change::appeared);
  EXPECT_EQ(world.of(45), Change::kept);
}

TEST(SessionChanges, BeyondTheRimOfWhatASessionMappedNothingIsGone) {
  TwoSessions world;
  for (core::LandmarkId id = 0; id < 100; ++id) {
    if (id % 10 >= 6) world.take_out(id, 1);  // the second reached x = 25 m only
  }
  const std::vector<ChangedLandmark> changes = world.changes();
  EXPECT_TRUE(std::none_of(changes.begin(), changes.end(), [](const ChangedLandmark& one) { return one.is_gone(); }));
}

/// The second session drove around them and saw trees on all sides of them.
TEST(SessionChanges, OutOfReachOfEveryLookNothingIsGone) {
  constexpr double reach_m = 15.0;
  TwoSessions world;
  for (core::LandmarkId id = 0; id < 100; ++id) {
    const Eigen::Vector2d at_m = world.place_m(id);
    if (std::min({at_m.x() + 4.0, at_m.y() + 4.0, 49.0 - at_m.x(), 49.0 - at_m.y()}) > reach_m) world.take_out(id, 1);
  }
  world.take_out(15, 1);  // 8 m from where it drove
  const std::vector<ChangedLandmark> changes = world.changes({world.views_of(0, 30.0), world.views_of(1, reach_m)});
  for (const ChangedLandmark& one : changes) EXPECT_EQ(one.is_gone(), one.id == 15) << one.id;
  const auto gone = std::find_if(changes.begin(), changes.end(), [](const auto& one) { return one.id == 15; });
  ASSERT_NE(gone, changes.end());
  EXPECT_LT(gone->missed_by_chance, 1e-3);
}

/// What is known of a map in memory is its landmarks, and how often each was seen.
TEST(SessionChanges, WithoutLooksNothingIsGoneBesideWhatWasSeldomSeen) {
  TwoSessions world;
  world.take_out(44, 1);
  EXPECT_EQ(world.of(44), Change::gone);
  world.was_seen(45, 2);
  const std::vector<ChangedLandmark> changes = world.changes();
  EXPECT_TRUE(std::none_of(changes.begin(), changes.end(), [](const ChangedLandmark& one) { return one.is_gone(); }));
}

/// Each session has its own copies there: the second did not miss a landmark that it has 1.7 m away.
TEST(SessionChanges, WhereTheSessionsAreBentApartNothingIsGoneNewOrMoved) {
  TwoSessions world;
  for (core::LandmarkId id = 0; id < 60; ++id) {
    world.take_out(id, 1);
    world.add(world.place_m(id) + Eigen::Vector2d(1.5, 0.8), false, true);
  }
  for (const ChangedLandmark& landmark : world.changes()) {
    if (landmark.point_m.y() < 18.0) {
      EXPECT_EQ(landmark.change(), Change::kept) << landmark.id;
    }
  }
}

TEST(SessionChanges, GoneAndNewNearerThanChanceMoved) {
  TwoSessions world;
  world.take_out(44, 1);
  const core::LandmarkId moved = world.add(world.place_m(44) + Eigen::Vector2d(0.5, 0.3), false, true);
  EXPECT_EQ(world.of(44), Change::moved);
  EXPECT_EQ(world.of(moved), Change::moved);
  for (const ChangedLandmark& landmark : world.changes()) {
    if (landmark.change() != Change::moved) continue;
    EXPECT_EQ(landmark.counterpart, landmark.id == moved ? 44 : moved);
  }
}

/// Stems beside each other, of which either may be either: they were not merged.
TEST(SessionChanges, GoneAndNewWhereTwoDrivesSeeOneLandmarkIsKept) {
  TwoSessions world;
  world.take_out(44, 1);
  const core::LandmarkId copy = world.add(world.place_m(44) + Eigen::Vector2d(0.1, 0.05), false, true);
  EXPECT_EQ(world.of(44), Change::kept);
  EXPECT_EQ(world.of(copy), Change::kept);
}

/// Two sessions bent against each other by less than is known of them: each has a copy of its own there.
TEST(SessionChanges, WhatNoSessionHasBothOfAndMayBeOneIsReportedAsThat) {
  TwoSessions world;
  world.take_out(44, 1);
  const core::LandmarkId copy = world.add(world.place_m(44) + Eigen::Vector2d(0.1, 0.05), false, true);
  const core::LandmarkId neighbour = world.add(world.place_m(55) + Eigen::Vector2d(0.1, 0.05), false, true);
  for (const ChangedLandmark& landmark : world.changes()) {
    const bool is_either = landmark.id == 44 || landmark.id == copy;
    EXPECT_EQ(landmark.perhaps_copy_of != core::no_landmark, is_either) << landmark.id;
    if (!is_either) continue;
    EXPECT_EQ(landmark.perhaps_copy_of, landmark.id == 44 ? copy : 44);
  }
  EXPECT_NE(world.of(neighbour), Change::gone) << "the second session has both, so they are two";
}

TEST(SessionChanges, WhereMuchIsNewTheSameDistanceIsChance) {
  TwoSessions world;
  world.take_out(44, 1);
  world.add(world.place_m(44) + Eigen::Vector2d(0.5, 0.3), false, true);
  core::RandomStream random(9, "undergrowth");
  for (int k = 0; k < 100; ++k) {
    const double x_m = random.uniform(0.0, 45.0);
    world.add({x_m, random.uniform(0.0, 45.0)}, false, true);
    if (k % 4 == 0 && k != 44) world.take_out(k, 1);
  }
  EXPECT_EQ(world.of(44), Change::gone);
}

TEST(SessionChanges, MovedGoesFromTheEarlierPlaceToTheLaterOneWhateverTheIds) {
  TwoSessions world;
  world.take_out(44, 0);
  const core::LandmarkId gone = world.add(world.place_m(44) + Eigen::Vector2d(0.5, 0.3), true, false);
  EXPECT_EQ(world.of(gone), Change::moved) << "from where it was in the first to where it is in the second";
  EXPECT_EQ(world.of(44), Change::moved);
}

TEST(SessionChanges, WhatIsGoneIsTentativeFromThenOn) {
  TwoSessions world;
  world.take_out(44, 1);
  world.take_out(45, 0);
  supervisor::JoinedSessions joined = world.joined();
  make_gone_tentative(world.changes(), joined.components);
  EXPECT_EQ(joined.components[0].states[44], core::LandmarkState::tentative);
  EXPECT_EQ(std::count(joined.components[0].states.begin(), joined.components[0].states.end(),
                       core::LandmarkState::tentative),
            1);
}

TEST(SessionChanges, ThePageWarnsOfMapsWithManyLandmarksTwice) {
  TwoSessions world;
  std::vector<ChangedLandmark> changes = world.changes();
  ASSERT_GE(changes.size(), 20u);
  EXPECT_TRUE(joined_warnings(world.joined(), changes).empty());
  for (std::size_t k = 0; k < 20; ++k) changes[k].perhaps_copy_of = changes[k ^ 1u].id;
  ASSERT_EQ(joined_warnings(world.joined(), changes).size(), 1u);
  const std::string page = joined_page({"monday", "tuesday"}, world.joined(), changes);
  EXPECT_NE(page.find("component 1: 10 of its"), std::string::npos);
}

TEST(SessionChanges, ThePageHasAMarkForEachAndNamesTheSessions) {
  TwoSessions world;
  world.take_out(44, 1);
  world.take_out(11, 1);
  world.add(world.place_m(11) + Eigen::Vector2d(0.6, 0.0), false, true);
  const std::string page = joined_page({"monday", "tues<day"}, world.joined(), world.changes());
  EXPECT_NE(page.find("landmark 44: gone; seen in monday; not in tues&lt;day"), std::string::npos);
  EXPECT_NE(page.find("landmark 11: moved"), std::string::npos);
  EXPECT_NE(page.find("1 gone"), std::string::npos);
  EXPECT_NE(page.find("1 moved"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace helixnav::apps
