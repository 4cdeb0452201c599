// SPDX-License-Identifier: BSD-3-Clause
// A robot of a team without names that is displaced without its odometry showing it.
#include <algorithm>

#include <gtest/gtest.h>
#include <Eigen/LU>

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

constexpr int slip_step = 40;
constexpr core::Nanoseconds slip_ns = 1'000'000'000LL * slip_step;

SmallTeam nameless(SmallTeamOptions options, std::uint64_t seed, bool slips) {
  options.seed = seed;
  if (slips) {
    options.slip_step = slip_step;
    options.slip = core::Pose2(0.35, -0.3, 0.06);
  }
  SmallTeam small = small_team(options);
  for (Message& message : small.messages) message.names.clear();
  return small;
}

TeamOptions without_names(bool slips) {
  TeamOptions options;
  options.join.by_names = false;
  options.join.by_place = true;
  options.slips = slips;
  return options;
}

double nees_of(const Team& team, const SmallTeam& small, int robot) {
  const core::PoseGaussian pose = team.pose(robot);
  const Eigen::Vector3d error = difference(small.last[static_cast<std::size_t>(robot)], pose.mean);
  return error.dot(pose.covariance.inverse() * error);
}

TEST(TeamSlip, IsFoundAndTheMapStaysOne) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SmallTeam small = nameless({}, seed, true);
    Team team = testing::run(small, known_starts(small), without_names(true));
    team.solve();
    ASSERT_EQ(team.slips().size(), 1u) << seed;
    EXPECT_EQ(team.slips().front().robot, 0);
    EXPECT_EQ(team.slips().front().t_ns, slip_ns);
    EXPECT_NEAR(team.slips().front().decision.moved_m, 0.46, 0.15);
    EXPECT_LE(team.map(0).size(), small.landmarks.size());
    EXPECT_LT(nees_of(team, small, 0), 16.3) << seed;  // 0.999 of χ² with 3
    EXPECT_LT(nees_of(team, small, 1), 16.3) << seed;
  }
}

TEST(TeamSlip, GoesWrongWhereItIsNotAskedFor) {
  const SmallTeam small = nameless({}, 1, true);
  Team team = testing::run(small, known_starts(small), without_names(false));
  team.solve();
  EXPECT_TRUE(team.slips().empty());
  EXPECT_GT(nees_of(team, small, 0), 50.0);
}

TEST(TeamSlip, IsNotFoundWhereThereIsNone) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SmallTeam small = nameless({}, seed, false);
    EXPECT_TRUE(testing::run(small, known_starts(small), without_names(true)).slips().empty()) << seed;
  }
}

TEST(TeamSlip, IsNotAskedForWithNames) {
  SmallTeamOptions slipping;
  slipping.slip_step = slip_step;
  slipping.slip = core::Pose2(0.35, -0.3, 0.06);
  const SmallTeam small = small_team(slipping);
  EXPECT_TRUE(testing::run(small, known_starts(small)).slips().empty());
}

TEST(TeamSlip, LateMessagesGiveTheSame) {
  const SmallTeam small = nameless({}, 2, true);
  SmallTeam late = small;
  for (auto k = late.messages.begin(); late.messages.end() - k > 40; k += 17) {
    if (k->what.index() != 0) std::rotate(k, k + 1, k + 40);  // motions come in order
  }
  const Team in_order = testing::run(small, known_starts(small), without_names(true));
  const Team disordered = testing::run(late, known_starts(small), without_names(true));
  ASSERT_EQ(in_order.slips().size(), 1u);
  ASSERT_EQ(disordered.slips().size(), 1u);
  EXPECT_EQ(in_order.slips().front().t_ns, disordered.slips().front().t_ns);
  EXPECT_EQ(in_order.slips().front().decision.nats, disordered.slips().front().decision.nats);
  EXPECT_EQ(in_order.pose(0).mean.vector(), disordered.pose(0).mean.vector());
  EXPECT_EQ(in_order.pose(0).covariance, disordered.pose(0).covariance);
}

}  // namespace
}  // namespace helixnav::team
