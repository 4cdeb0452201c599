// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/team/team.hpp"

#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
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

TeamOptions never_solving() {
  TeamOptions options;
  options.solve_every_s = 1e6;
  options.clone_sigma_m = options.clone_sigma_rad = 0.0;  // a pose for every sighting: nothing approximated
  return options;
}

TEST(Team, FilterOverAllRobotsEqualsTheGraphAtSmallNoise) {
  SmallTeamOptions tiny;
  tiny.robots = 3;
  tiny.noise = 0.05;
  const SmallTeam small = small_team(tiny);
  Team team = testing::run(small, known_starts(small), never_solving());
  std::vector<core::PoseGaussian> filtered;
  for (int r = 0; r < 3; ++r) filtered.push_back(team.pose(r));
  team.solve();
  for (int r = 0; r < 3; ++r) {
    const core::PoseGaussian solved = team.pose(r);
    const double sigma_m = std::sqrt(solved.covariance(0, 0));
    EXPECT_LT(difference(filtered[static_cast<std::size_t>(r)].mean, solved.mean).norm(), 0.02 * sigma_m);
    EXPECT_NEAR(filtered[static_cast<std::size_t>(r)].covariance(0, 0) / solved.covariance(0, 0), 1.0, 0.01);
    EXPECT_NEAR(filtered[static_cast<std::size_t>(r)].covariance(2, 2) / solved.covariance(2, 2), 1.0, 0.01);
  }
}

TEST(Team, IsConsistentWithKnownStarts) {
  double nees = 0.0;
  constexpr int drives = 30;
  for (int k = 0; k < drives; ++k) {
    SmallTeamOptions options;
    options.seed = 100 + static_cast<std::uint64_t>(k);
    const SmallTeam small = small_team(options);
    const Team team = testing::run(small, known_starts(small));
    const core::PoseGaussian pose = team.pose(1);
    const Eigen::Vector3d e = difference(pose.mean, small.last[1]);
    nees += e.dot(pose.covariance.ldlt().solve(e));
  }
  // Two-sided, false alarm 1e-4.
  EXPECT_GT(nees, core::chi2_quantile(0.5e-4, 3 * drives));
  EXPECT_LT(nees, core::chi2_quantile(1.0 - 0.5e-4, 3 * drives));
}

TEST(Team, LateMessagesGiveTheSameBytes) {
  const SmallTeam small = small_team();
  const Team in_time = testing::run(small, known_starts(small));
  std::vector<Message> late = small.messages;
  for (std::size_t i = 0; i + 40 < late.size(); i += 17) {
    // The motion of one robot must come in order; sightings and scans may wait for any time.
    if (late[i].what.index() != 0)
      std::rotate(late.begin() + static_cast<std::ptrdiff_t>(i), late.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                  late.begin() + static_cast<std::ptrdiff_t>(i) + 40);
  }
  Team team(known_starts(small));
  for (const Message& message : late) testing::give(team, message);
  for (int r = 0; r < 2; ++r) {
    EXPECT_EQ(team.pose(r).mean.vector(), in_time.pose(r).mean.vector());
    EXPECT_EQ(team.pose(r).covariance, in_time.pose(r).covariance);
  }
  EXPECT_EQ(team.map(0).size(), in_time.map(0).size());
}

TEST(Team, ASightingWaitsForTheMotionOfTheRobotSeen) {
  const SmallTeam small = small_team();
  const Team in_time = testing::run(small, known_starts(small));
  // Everything from robot 1 comes a second late.
  std::vector<Message> behind = small.messages;
  const auto heard_ns = [](const Message& m) { return m.t_ns + (m.robot == 1 ? 1'500'000'000LL : 0); };
  std::stable_sort(behind.begin(), behind.end(),
                   [&](const Message& a, const Message& b) { return heard_ns(a) < heard_ns(b); });
  Team team(known_starts(small));
  for (const Message& message : behind) testing::give(team, message);
  EXPECT_EQ(team.pose(0).mean.vector(), in_time.pose(0).mean.vector());
  EXPECT_EQ(team.sightings().size(), in_time.sightings().size());
}

TEST(Team, ARobotSeenWithinAnIncrementIsInterpolated) {
  const core::Pose2 far(3.0, 0.0, 2.0);
  const std::vector<std::optional<core::PoseGaussian>> starts{core::PoseGaussian{},
                                                              core::PoseGaussian{far, Eigen::Matrix3d::Zero()}};
  const auto motion = [](double t_s, double way_m, double turn_rad) {
    core::Odometry odometry;
    odometry.t_ns = core::nanoseconds_from_seconds(t_s);
    odometry.T_before_after = core::Pose2(way_m, 0.0, turn_rad);
    odometry.covariance = 1e-4 * Eigen::Matrix3d::Identity();
    return odometry;
  };
  Team team(starts);
  team.take(0, motion(1.0, 0.0, 0.0));
  team.take(0, motion(2.0, 0.0, 0.0));
  team.take(1, motion(1.0, 0.0, 0.0));
  core::RobotSighting sighting{core::nanoseconds_from_seconds(1.5), 1, core::Pose2(),
                               core::make_range_bearing(3.0, 0.0, 0.01, 0.01)};
  team.sight(0, sighting);
  EXPECT_TRUE(team.sightings().empty());  // waits
  team.take(1, motion(2.0, 1.0, 0.0));
  ASSERT_EQ(team.sightings().size(), 1u);
  const std::vector<core::StampedPose> path = team.path(1);
  const core::Pose2 half = core::compose(far, core::Pose2(0.5, 0.0, 0.0));
  EXPECT_EQ(path.back().t_ns, sighting.t_ns);
  EXPECT_LT(difference(path.back().T_world_robot, half).norm(), 0.1);
}

TEST(Team, SightingsOneEachWayJoinRobotsOfUnknownStart) {
  SmallTeam small = small_team();
  TeamOptions options;
  options.join.by_names = false;
  Team team = testing::run(small, unknown_starts(small), options);
  team.solve();
  ASSERT_EQ(team.joins().size(), 1u);
  EXPECT_EQ(team.joins()[0].by, TeamJoin::By::sightings);
  EXPECT_EQ(team.component(1), 0);
  const core::Pose2 truth = core::between(small.last[0], small.last[1]);
  const core::Pose2 estimate = core::between(team.pose(0).mean, team.pose(1).mean);
  EXPECT_LT(difference(estimate, truth).head<2>().norm(), 0.15);
  EXPECT_LT(std::abs(difference(estimate, truth)[2]), 0.05);
}

TEST(Team, CommonNamesJoinRobotsThatDoNotSeeEachOther) {
  SmallTeamOptions blind;
  blind.see_each_other = false;
  const SmallTeam small = small_team(blind);
  Team team = testing::run(small, unknown_starts(small));
  team.solve();
  ASSERT_EQ(team.joins().size(), 1u);
  EXPECT_EQ(team.joins()[0].by, TeamJoin::By::names);
  EXPECT_LE(team.map(0).size(), small.landmarks.size());
  for (std::int64_t name = 0; name < 12; ++name) {
    const core::LandmarkId a = team.landmark_of(0, name), b = team.landmark_of(1, name);
    if (a == core::no_landmark || b == core::no_landmark) continue;
    EXPECT_EQ(a, b);
  }
  const core::Pose2 truth = core::between(small.last[0], small.last[1]);
  EXPECT_LT(difference(core::between(team.pose(0).mean, team.pose(1).mean), truth).head<2>().norm(), 0.15);
}

TEST(Team, NamesThatContradictEachOtherDoNotJoin) {
  SmallTeamOptions blind;
  blind.see_each_other = false;
  SmallTeam small = small_team(blind);
  for (Message& message : small.messages) {
    if (message.robot != 1) continue;
    for (std::int64_t& name : message.names) name = (name * 5 + 1) % 12;  // everything is called something else
  }
  Team team = testing::run(small, unknown_starts(small));
  team.solve();
  EXPECT_TRUE(team.joins().empty());
  EXPECT_EQ(team.component(1), 1);
}

TEST(Team, AJoinedTeamEqualsTheTeamOfKnownStarts) {
  SmallTeamOptions tiny;
  tiny.noise = 1e-3;
  const SmallTeam small = small_team(tiny);
  Team known = testing::run(small, known_starts(small));
  known.solve();
  Team joined = testing::run(small, unknown_starts(small));
  joined.solve();
  ASSERT_EQ(joined.joins().size(), 1u);
  // With unknown starts, the joint least squares lacks what the second start tells, and nothing else.
  const core::Pose2 a = core::between(known.pose(0).mean, known.pose(1).mean);
  const core::Pose2 b = core::between(joined.pose(0).mean, joined.pose(1).mean);
  EXPECT_LT(difference(a, b).norm(), 2e-5);
}

TEST(Team, AJoinTakenBackLeavesNoTrace) {
  const SmallTeam small = small_team();
  TeamOptions options;
  options.join.by_names = false;
  Team team = testing::run(small, unknown_starts(small), options);
  ASSERT_EQ(team.joins().size(), 1u);
  team.remove_join(0);
  EXPECT_TRUE(team.joins().empty());
  options.join.by_sightings = false;
  const Team never = testing::run(small, unknown_starts(small), options);
  for (int r = 0; r < 2; ++r) EXPECT_EQ(team.pose(r).mean.vector(), never.pose(r).mean.vector());
}

TEST(Team, AJoinOfThreeTakenBackLeavesTheOtherTwoTogether) {
  SmallTeamOptions three;
  three.robots = 3;
  three.see_each_other = false;
  const SmallTeam small = small_team(three);
  Team team = testing::run(small, unknown_starts(small));
  team.solve();
  ASSERT_EQ(team.joins().size(), 2u);
  const TeamJoin last = team.joins()[1];
  team.remove_join(1);
  team.solve();
  ASSERT_EQ(team.joins().size(), 1u);
  EXPECT_NE(team.component(last.robot), team.component(last.other));
  EXPECT_EQ(team.component(team.joins()[0].other), team.component(team.joins()[0].robot));
}

TEST(Team, JoinsComeOutTheSameOfMessagesOutOfOrder) {
  SmallTeamOptions three;
  three.robots = 3;
  const SmallTeam small = small_team(three);
  const Team in_time = testing::run(small, unknown_starts(small));
  // Robot 1 is heard 7 s late, robot 2 after 3 s: joins are found, taken back with the rewind and found again.
  std::vector<Message> behind = small.messages;
  const auto heard_ns = [](const Message& m) {
    return m.t_ns + (m.robot == 1 ? 7'300'000'000LL : m.robot == 2 ? 3'100'000'000LL : 0);
  };
  std::stable_sort(behind.begin(), behind.end(),
                   [&](const Message& a, const Message& b) { return heard_ns(a) < heard_ns(b); });
  Team team(unknown_starts(small));
  for (const Message& message : behind) testing::give(team, message);
  ASSERT_EQ(in_time.joins().size(), 2u);
  ASSERT_EQ(team.joins().size(), 2u);
  for (std::size_t j = 0; j < 2; ++j) {
    EXPECT_EQ(team.joins()[j].t_ns, in_time.joins()[j].t_ns);
    EXPECT_EQ(team.joins()[j].cost, in_time.joins()[j].cost);
  }
  for (int r = 0; r < 3; ++r) {
    EXPECT_EQ(team.pose(r).mean.vector(), in_time.pose(r).mean.vector());
    EXPECT_EQ(team.pose(r).covariance, in_time.pose(r).covariance);
  }
}

/// Robots are seen between two increments, which are cut there; every fifth increment comes two seconds late.
TEST(Team, DisorderedMotionGivesTheSameBytes) {
  SmallTeam small = small_team();
  for (Message& message : small.messages) {
    auto* sighting = std::get_if<core::RobotSighting>(&message.what);
    if (sighting != nullptr) message.t_ns = sighting->t_ns -= 400'000'000LL;
  }
  const auto by_time = [](const Message& a, const Message& b) { return a.t_ns < b.t_ns; };
  std::stable_sort(small.messages.begin(), small.messages.end(), by_time);
  const Team in_time = testing::run(small, known_starts(small));
  int increments = 0;
  for (Message& message : small.messages) {
    const bool is_late = std::holds_alternative<core::Odometry>(message.what) && ++increments % 5 == 0;
    if (is_late) message.t_ns += 2'100'000'000LL;
  }
  std::stable_sort(small.messages.begin(), small.messages.end(), by_time);
  const Team team = testing::run(small, known_starts(small));
  for (int r = 0; r < 2; ++r) {
    EXPECT_EQ(team.pose(r).mean.vector(), in_time.pose(r).mean.vector());
    EXPECT_EQ(team.pose(r).covariance, in_time.pose(r).covariance);
  }
}

bool is_sighting_of(const Message& message, int robot) {
  return message.robot == robot && std::holds_alternative<core::RobotSighting>(message.what);
}

/// Keeps only those sightings of one another for which `keep` holds.
template <class Keep>
SmallTeam with_sightings(SmallTeam small, const Keep& keep) {
  std::vector<Message>& all = small.messages;
  const auto goes = [&](const Message& message) {
    return std::holds_alternative<core::RobotSighting>(message.what) && !keep(message);
  };
  all.erase(std::remove_if(all.begin(), all.end(), goes), all.end());
  return small;
}

/// As if another robot were sighted, as far away in another direction.
void make_false(Message& message) { std::get<core::RobotSighting>(message.what).observation.z[1] += 1.5; }

constexpr core::Nanoseconds second_ns = 1'000'000'000;

/// Two sightings agree with any two directions: one degree of freedom, that of the range.
TEST(Team, AJoinThatAllLaterSightingsContradictIsTakenBack) {
  SmallTeam small = with_sightings(small_team(), [](const Message& message) {
    return message.t_ns == 5 * second_ns || message.t_ns > 12 * second_ns;
  });
  for (Message& message : small.messages) {
    if (is_sighting_of(message, 0) && message.t_ns == 5 * second_ns) make_false(message);
  }
  TeamOptions options;
  options.join.by_names = false;
  Team at_first(unknown_starts(small), options);
  for (const Message& message : small.messages) {
    if (message.t_ns <= 12 * second_ns) testing::give(at_first, message);
  }
  ASSERT_EQ(at_first.joins().size(), 1u) << "nothing contradicts it yet";
  const Team team = testing::run(small, unknown_starts(small), options);
  ASSERT_EQ(team.joins().size(), 1u);
  EXPECT_GT(team.joins()[0].t_ns, 12 * second_ns);
  ASSERT_EQ(team.joins_taken_back().size(), 1u);
  const TakenBackJoin& back = team.joins_taken_back()[0];
  EXPECT_EQ(back.join.t_ns, at_first.joins()[0].t_ns);
  EXPECT_GT(back.t_ns, 12 * second_ns);
  EXPECT_GE(back.refused, 6);
  EXPECT_GT(2 * back.refused, back.seen);
  const core::Pose2 truth = core::between(small.last[0], small.last[1]);
  EXPECT_LT(difference(core::between(team.pose(0).mean, team.pose(1).mean), truth).head<2>().norm(), 0.2);
}

/// Robots 0 and 2 do not meet robot 1 again, and 0 takes the other for it.
TEST(Team, SightingsOfARobotTakenForAnotherDoNotContradictAJoin) {
  SmallTeamOptions three;
  three.robots = 3;
  SmallTeam small = with_sightings(small_team(three), [](const Message& message) {
    return message.t_ns <= 12 * second_ns ||
           (message.robot == 0 && std::get<core::RobotSighting>(message.what).seen == 2);
  });
  int mistaken = 0;
  for (Message& message : small.messages) {
    if (message.t_ns <= 12 * second_ns || !is_sighting_of(message, 0)) continue;
    std::get<core::RobotSighting>(message.what).seen = 1;
    ++mistaken;
  }
  ASSERT_GE(mistaken, 6);
  TeamOptions options;
  options.join.by_names = false;
  const Team team = testing::run(small, unknown_starts(small), options);
  EXPECT_EQ(team.joins().size(), 2u);
  EXPECT_TRUE(team.joins_taken_back().empty());
}

TEST(Team, DoesNotJoinWhatSightingsBeforeContradict) {
  SmallTeam small = with_sightings(small_team(), [](const Message& message) {
    return message.t_ns <= 15 * second_ns && (message.robot == 1 || message.t_ns == 14 * second_ns);
  });
  TeamOptions options;
  options.join.by_names = false;
  EXPECT_EQ(testing::run(small, unknown_starts(small), options).joins().size(), 1u);
  for (Message& message : small.messages) {
    if (is_sighting_of(message, 0)) make_false(message);
  }
  EXPECT_TRUE(testing::run(small, unknown_starts(small), options).joins().empty());
}

TEST(Team, ALandmarkFirstSeenUnderAnothersNameIsBegunAnew) {
  SmallTeam small = small_team();
  constexpr std::int64_t name = 3;
  const auto first = std::find_if(small.messages.begin(), small.messages.end(), [&](const Message& message) {
    return std::find(message.names.begin(), message.names.end(), name) != message.names.end();
  });
  const auto at = std::find(first->names.begin(), first->names.end(), name) - first->names.begin();
  std::get<core::Scan>(first->what).observations[static_cast<std::size_t>(at)].z[1] += 2.0;
  Team right = testing::run(small_team(), known_starts(small));
  right.solve();
  Team team = testing::run(small, known_starts(small));
  team.solve();
  const core::LandmarkId id = team.landmark_of(0, name);
  ASSERT_NE(id, core::no_landmark);
  const std::vector<core::MapLandmark> map = team.map(0);
  EXPECT_EQ(map.size(), right.map(0).size());
  const auto found =
      std::find_if(map.begin(), map.end(), [&](const core::MapLandmark& landmark) { return landmark.id == id; });
  ASSERT_NE(found, map.end());
  EXPECT_LT((found->point.mean_m - small.landmarks[name]).norm(), 0.2);
  EXPECT_GE(found->observations, 10);
}

TEST(Team, ALandmarkUnderANameReadOnceIsTentative) {
  SmallTeam small = small_team();
  constexpr std::int64_t misread = 99;
  const auto middle = small.messages.begin() + static_cast<std::ptrdiff_t>(small.messages.size() / 2);
  Message& scan = *std::find_if(middle, small.messages.end(), [](const Message& one) { return !one.names.empty(); });
  scan.names.front() = misread;
  const Team team = testing::run(small, known_starts(small));
  for (const core::MapLandmark& landmark : team.map(0)) {
    const bool is_misread = landmark.id == team.landmark_of(scan.robot, misread);
    EXPECT_EQ(landmark.state, is_misread ? core::LandmarkState::tentative : core::LandmarkState::mature);
  }
}

TEST(Team, AFalseSightingIsGatedOut) {
  SmallTeam small = small_team();
  Team team = testing::run(small, known_starts(small));
  const core::Nanoseconds t_ns = small.messages.back().t_ns;
  const core::PoseGaussian before = team.pose(0);
  team.sight(0, {t_ns, 1, core::Pose2(), core::make_range_bearing(30.0, 1.0, 0.05, 0.01)});
  int refused = 0;
  for (const JudgedSighting& sighting : team.sightings()) refused += sighting.used ? 0 : 1;
  EXPECT_EQ(refused, 1);
  EXPECT_LT(difference(team.pose(0).mean, before.mean).norm(), 1e-9);
}

TEST(Team, RefusesRobotsThatAreNotThereAndGarbledEventsUnchanged) {
  const SmallTeam small = small_team();
  Team team = testing::run(small, known_starts(small));
  const core::PoseGaussian before = team.pose(0);
  EXPECT_THROW(team.take(2, core::Odometry{}), core::PreconditionError);
  EXPECT_THROW(team.sight(0, {0, 7, core::Pose2(), core::make_range_bearing(1.0, 0.0, 0.1, 0.1)}),
               core::PreconditionError);
  EXPECT_THROW(team.sight(0, {0, 0, core::Pose2(), core::make_range_bearing(1.0, 0.0, 0.1, 0.1)}),
               core::PreconditionError);
  core::AbsoluteFix fix;
  fix.covariance_m2.setIdentity();
  EXPECT_THROW(team.take(0, fix), core::PreconditionError);
  core::Scan scan;
  scan.t_ns = small.messages.back().t_ns;
  scan.observations.push_back(core::make_range(1.0, 0.1));
  EXPECT_THROW(team.take(0, scan, {3}), core::PreconditionError);
  EXPECT_THROW(team.take(0, scan, {}), core::PreconditionError);
  EXPECT_EQ(team.pose(0).mean.vector(), before.mean.vector());
}

TEST(Team, RefusesOptionsAndStartsThatNothingCouldComeOf) {
  for (const double looks : {-1.0, 0.0, 0.5, std::numeric_limits<double>::quiet_NaN()}) {
    TeamOptions options;
    options.looks_as_one = looks;
    EXPECT_THROW(Team({std::nullopt}, options), core::PreconditionError) << looks;
  }
  core::PoseGaussian far;
  far.mean.x_m = 1e9;
  EXPECT_THROW(Team({far}), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::team
