// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/scale_lengths.hpp"

#include <gtest/gtest.h>

namespace helixnav::supervisor {
namespace {

TEST(ScaleLengths, ScalesWhatIsSeenAndLeavesPatienceAndAngles) {
  const SearchOptions before;
  const SearchOptions after = scale_lengths(before, 0.1);
  EXPECT_DOUBLE_EQ(after.look_distance_m, 0.1 * before.look_distance_m);
  EXPECT_DOUBLE_EQ(after.reach_m, 0.1 * before.reach_m);
  EXPECT_DOUBLE_EQ(after.rivals.apart_m, 0.1 * before.rivals.apart_m);
  EXPECT_DOUBLE_EQ(after.constellation.most_tolerance_m, 0.1 * before.constellation.most_tolerance_m);
  EXPECT_DOUBLE_EQ(after.rivals.extraneous_per_m2, 100.0 * before.rivals.extraneous_per_m2);
  EXPECT_EQ(after.undecided_m, before.undecided_m);
  EXPECT_EQ(after.foreign_per_scan, before.foreign_per_scan);
  EXPECT_EQ(after.rivals.apart_rad, before.rivals.apart_rad);
}

TEST(ScaleLengths, IsUndoneByTheInverse) {
  const SearchOptions before;
  const SearchOptions back = scale_lengths(scale_lengths(before, 0.25), 4.0);
  EXPECT_DOUBLE_EQ(back.rest_m, before.rest_m);
  EXPECT_DOUBLE_EQ(back.relocalizer.bin_m, before.relocalizer.bin_m);
  EXPECT_DOUBLE_EQ(back.rivals.extraneous_per_m2, before.rivals.extraneous_per_m2);
}

}  // namespace
}  // namespace helixnav::supervisor
