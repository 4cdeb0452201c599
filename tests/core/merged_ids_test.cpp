// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/merged_ids.hpp"

#include <gtest/gtest.h>

namespace helixnav::core {
namespace {

TEST(MergedIds, FollowsAChainOfMergesToItsEnd) {
  std::vector<StepReport> steps(3);
  steps[0].merged = {{4, 17}, {5, 18}};
  steps[2].merged = {{2, 4}};
  const MergedIds ids(steps);
  EXPECT_EQ(ids.now(17), 2);
  EXPECT_EQ(ids.now(4), 2);
  EXPECT_EQ(ids.now(18), 5);
  EXPECT_EQ(ids.now(5), 5);
  EXPECT_EQ(ids.now(99), 99);
}

TEST(MergedIds, EndsAfterAMergeTheOtherWayRoundAndOfALandmarkWithItself) {
  MergedIds ids;
  ids.merge({1, 2});
  ids.merge({2, 1});  // the first was undone by a rollback
  EXPECT_EQ(ids.now(1), 2);
  EXPECT_EQ(ids.now(2), 2);
  ids.merge({2, 2});
  EXPECT_EQ(ids.now(2), 2);
}

TEST(MergedIds, TakesTheLastMergeOfALandmarkThatWasRemovedTwice) {
  MergedIds ids;
  ids.merge({1, 3});
  ids.merge({2, 3});  // the first was undone by a rollback
  EXPECT_EQ(ids.now(3), 2);
  EXPECT_EQ(ids.now(1), 1);
}

}  // namespace
}  // namespace helixnav::core
