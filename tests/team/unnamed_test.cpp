// SPDX-License-Identifier: BSD-3-Clause
#include <set>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/team/team.hpp"
#include "small_team.hpp"

namespace helixnav::team {
namespace {

using testing::difference;
using testing::known_starts;
using testing::Message;
using testing::small_team;
using testing::SmallTeam;
using testing::SmallTeamOptions;
using testing::unknown_starts;

TeamOptions by_place() {
  TeamOptions options;
  options.join.by_names = false;
  options.join.by_constellation = options.join.by_place = true;
  return options;
}

SmallTeam without_names(SmallTeam small) {
  for (Message& message : small.messages) message.names.clear();
  return small;
}

/// Each robot knows its own landmarks by names that mean nothing to others.
SmallTeam with_private_names(SmallTeam small) {
  for (Message& message : small.messages) {
    for (std::int64_t& name : message.names) name += 100 * message.robot;
  }
  return small;
}

double relative_error_m(const Team& team, const SmallTeam& small) {
  const core::Pose2 truth = core::between(small.last[0], small.last[1]);
  return difference(core::between(team.pose(0).mean, team.pose(1).mean), truth).head<2>().norm();
}

TEST(UnnamedTeam, RobotsOfOneFrameShareTheirLandmarks) {
  SmallTeamOptions blind;
  blind.see_each_other = false;
  const SmallTeam small = without_names(small_team(blind));
  Team team = testing::run(small, known_starts(small), by_place());
  team.solve();
  EXPECT_LE(team.map(0).size(), small.landmarks.size());
  EXPECT_LT(relative_error_m(team, small), 0.15);
}

TEST(UnnamedTeam, RobotsThatMetMakeOneMapOfTwo) {
  const SmallTeam small = without_names(small_team());
  Team team = testing::run(small, unknown_starts(small), by_place());
  team.solve();
  ASSERT_EQ(team.joins().size(), 1u);
  ASSERT_FALSE(team.same_landmarks().empty());
  for (const SameLandmarks& one : team.same_landmarks()) EXPECT_LE(one.cost, one.limit);
  EXPECT_LE(team.map(0).size(), small.landmarks.size());
  EXPECT_LT(relative_error_m(team, small), 0.15);
}

TEST(UnnamedTeam, NamesOfTwoRobotsForOneLandmarkBecomeOne) {
  const SmallTeam small = with_private_names(small_team());
  Team team = testing::run(small, unknown_starts(small), by_place());
  team.solve();
  ASSERT_EQ(team.joins().size(), 1u);
  int one = 0;
  for (std::int64_t name = 0; name < 12; ++name) {
    const core::LandmarkId ours = team.landmark_of(0, name);
    for (std::int64_t other = 0; other < 12 && ours != core::no_landmark; ++other) {
      if (team.landmark_of(1, 100 + other) != ours) continue;
      EXPECT_EQ(name, other);
      ++one;
    }
  }
  EXPECT_GE(one, 8);
}

TEST(UnnamedTeam, WhatWasMadeOneCanBeTakenBack) {
  const SmallTeam small = with_private_names(small_team());
  Team team = testing::run(small, known_starts(small), by_place());
  team.solve();
  ASSERT_FALSE(team.same_landmarks().empty());
  const std::set<std::int64_t> names{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  const SameLandmarks first = team.same_landmarks().front();
  const auto name = std::find_if(names.begin(), names.end(),
                                 [&](std::int64_t one) { return team.landmark_of(0, one) == first.kept; });
  ASSERT_NE(name, names.end());
  ASSERT_EQ(team.landmark_of(1, 100 + *name), first.kept);
  EXPECT_THROW(team.remove_same(team.same_landmarks().size()), core::PreconditionError);
  EXPECT_THROW(team.remove_join(team.joins().size()), core::PreconditionError);
  team.remove_same(0);
  team.solve();
  EXPECT_NE(team.landmark_of(0, *name), team.landmark_of(1, 100 + *name));
}

TEST(UnnamedTeam, LateMessagesGiveTheSameBytesWithoutNames) {
  const SmallTeam small = without_names(small_team());
  const Team in_time = testing::run(small, unknown_starts(small), by_place());
  std::vector<Message> behind = small.messages;
  const auto heard_ns = [](const Message& m) { return m.t_ns + (m.robot == 1 ? 7'300'000'000LL : 0); };
  std::stable_sort(behind.begin(), behind.end(),
                   [&](const Message& a, const Message& b) { return heard_ns(a) < heard_ns(b); });
  Team team(unknown_starts(small), by_place());
  for (const Message& message : behind) testing::give(team, message);
  ASSERT_EQ(team.same_landmarks().size(), in_time.same_landmarks().size());
  for (int r = 0; r < 2; ++r) EXPECT_EQ(team.pose(r).mean.vector(), in_time.pose(r).mean.vector());
}

TEST(UnnamedTeam, WhatIsSeenOnceIsForgotten) {
  SmallTeam small = without_names(small_team());
  core::RandomStream random(3, "clutter");
  for (Message& message : small.messages) {
    auto* scan = std::get_if<core::Scan>(&message.what);
    if (scan == nullptr) continue;
    const double bearing_rad = random.uniform(-3.0, 3.0);
    const double range_m = random.uniform(9.0, 60.0);  // beyond the reach: nothing is there
    scan->observations.push_back(core::make_range_bearing(range_m, bearing_rad, 0.05, 0.01));
  }
  Team team = testing::run(small, known_starts(small), by_place());
  team.solve();
  team.solve();
  EXPECT_LE(team.map(0).size(), small.landmarks.size() + 4);
  EXPECT_LT(relative_error_m(team, small), 0.15);
}

TEST(UnnamedTeam, LooksThatSayWhatOneWouldAreToldApartByTheNoiseOfOne) {
  SmallTeamOptions options;
  options.drawn = 0.25;  // noise as given is four times that of a look
  options.noise = 4.0;
  options.twin_m = 0.6;
  const SmallTeam small = without_names(small_team(options));
  TeamOptions looks = by_place();
  looks.looks_as_one = 16.0;
  const Team told = testing::run(small, known_starts(small), looks);
  const Team untold = testing::run(small, known_starts(small), by_place());
  EXPECT_LT(untold.map(0).size(), small.landmarks.size() - 4);
  EXPECT_GE(told.map(0).size(), small.landmarks.size() - 4);
  EXPECT_LE(told.map(0).size(), small.landmarks.size());
}

}  // namespace
}  // namespace helixnav::team
