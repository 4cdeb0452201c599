// SPDX-License-Identifier: BSD-3-Clause
// Whether the pairs of a closing are at a place where the whole map says that the vehicle may be.
#include <vector>

#include <gtest/gtest.h>

#include "search/whole_map_questions.hpp"

namespace helixnav::supervisor {
namespace {

using Pairs = std::vector<pf_relocalize::ConstellationPair>;

AskedWholeMap may_be_at(std::vector<Pairs> places) {
  AskedWholeMap asked;
  asked.may_be = std::move(places);
  return asked;
}

TEST(AskedWholeMap, SaysNothingWhereNoPlaceIsKnown) { EXPECT_FALSE(AskedWholeMap{}.is_elsewhere({{100, 1}})); }

TEST(AskedWholeMap, AgreesWithOneOfSeveralPlaces) {
  const AskedWholeMap asked = may_be_at({{{100, 1}, {101, 2}, {102, 3}}, {{100, 2}, {101, 3}, {102, 4}}});
  EXPECT_FALSE(asked.is_elsewhere({{100, 2}, {101, 3}}));
  EXPECT_TRUE(asked.is_elsewhere({{100, 7}, {101, 8}}));
}

// A turned lattice brings a single landmark onto its partner by chance, and a pair of a right place may be wrong.
TEST(AskedWholeMap, GoesByMostOfThePairsOfBoth) {
  const AskedWholeMap asked = may_be_at({{{100, 1}, {101, 2}, {102, 3}}});
  EXPECT_TRUE(asked.is_elsewhere({{100, 1}, {101, 8}, {102, 9}}));
  EXPECT_FALSE(asked.is_elsewhere({{100, 1}, {101, 2}, {102, 9}}));
  EXPECT_FALSE(asked.is_elsewhere({{100, 1}, {101, 2}, {103, 8}, {104, 9}, {105, 10}})) << "the others are not in both";
}

TEST(AskedWholeMap, PairsOfOtherLandmarksAreElsewhere) {
  EXPECT_TRUE(may_be_at({{{100, 1}}}).is_elsewhere({{200, 1}}));
}

}  // namespace
}  // namespace helixnav::supervisor
