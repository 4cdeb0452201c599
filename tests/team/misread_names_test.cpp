// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <ctime>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "small_team.hpp"

namespace helixnav::team {
namespace {

using testing::Message;
using testing::SmallTeam;
using testing::SmallTeamOptions;

SmallTeam blind_team() {
  SmallTeamOptions options;
  options.see_each_other = false;
  return testing::small_team(options);
}

std::vector<std::int64_t> first_names(const SmallTeam& small, int robot) {
  const auto first = std::find_if(small.messages.begin(), small.messages.end(), [&](const Message& message) {
    return message.robot == robot && !message.names.empty();
  });
  return first->names;
}

/// What robot 0 sees at first, and what robot 1 sees at first and may take for it.
std::pair<std::int64_t, std::int64_t> mistaken_names(const SmallTeam& small) {
  const std::int64_t hidden = first_names(small, 0).front();
  const std::vector<std::int64_t> others = first_names(small, 1);
  return {hidden, *std::find_if(others.begin(), others.end(), [&](std::int64_t name) { return name != hidden; })};
}

/// Robot 1 never reports `hidden` by its name, but calls `taken_for` so `times` times, from the first time it sees it.
SmallTeam with_misread(SmallTeam small, std::int64_t hidden, std::int64_t taken_for, int times) {
  for (Message& message : small.messages) {
    if (message.robot != 1) continue;
    for (std::int64_t& name : message.names) {
      if (name == hidden) {
        name = -1;
      } else if (name == taken_for && times > 0) {
        name = hidden;
        --times;
      }
    }
  }
  return small;
}

TEST(MisreadNames, OneOfManyKeepsNoRobotOut) {
  const auto [hidden, taken_for] = mistaken_names(blind_team());
  const SmallTeam small = with_misread(blind_team(), hidden, taken_for, 1);
  Team team = testing::run(small, testing::unknown_starts(small));
  team.solve();
  ASSERT_EQ(team.joins().size(), 1u);
  EXPECT_EQ(team.joins()[0].left_out, 1);
  EXPECT_LE(team.map(0).size(), small.landmarks.size()) << "the landmark that the misread name began is gone";
  const core::Pose2 truth = core::between(small.last[0], small.last[1]);
  const core::Pose2 told = core::between(team.pose(0).mean, team.pose(1).mean);
  EXPECT_LT((told.position_m() - truth.position_m()).norm(), 0.2);
}

TEST(MisreadNames, OneThatIsAlwaysMisreadStaysALandmarkOfItsOwn) {
  const auto [hidden, taken_for] = mistaken_names(blind_team());
  const SmallTeam small = with_misread(blind_team(), hidden, taken_for, 1000);
  Team team = testing::run(small, testing::unknown_starts(small));
  team.solve();
  ASSERT_EQ(team.joins().size(), 1u);
  EXPECT_EQ(team.joins()[0].left_out, 1);
  EXPECT_NE(team.landmark_of(0, hidden), team.landmark_of(1, hidden));
}

/// Every third name is another landmark's: no longer only a few.
TEST(MisreadNames, TooManyJoinNothing) {
  SmallTeam small = blind_team();
  for (Message& message : small.messages) {
    if (message.robot != 1) continue;
    for (std::int64_t& name : message.names) name = name < 6 ? (name + 1) % 6 : name;
  }
  Team team = testing::run(small, testing::unknown_starts(small));
  team.solve();
  EXPECT_TRUE(team.joins().empty());
}

struct TimedRun {
  double cpu_s = 0.0;
  std::size_t joins = 0;
};

TimedRun timed_run(const SmallTeam& small) {
  const std::clock_t begin = std::clock();
  const Team team = testing::run(small, testing::unknown_starts(small));
  return {static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, team.joins().size()};
}

/// Nobody's names agree, while the robots see each other and so have a reason to ask again at each solution.
TEST(MisreadNames, ThatAllContradictTakeNoLongTimeToRefuse) {
  SmallTeamOptions options;
  options.steps = 120;
  const SmallTeam right = testing::small_team(options);
  SmallTeam shifted = right;
  for (Message& message : shifted.messages) {
    if (message.robot != 1) continue;
    for (std::int64_t& name : message.names) name = (name + 1) % 12;
  }
  const TimedRun joined = timed_run(right);
  const TimedRun apart = timed_run(shifted);
  EXPECT_EQ(joined.joins, 1u);
  EXPECT_EQ(apart.joins, 0u);
  EXPECT_LT(apart.cpu_s, 5.0 * joined.cpu_s);
}

}  // namespace
}  // namespace helixnav::team
