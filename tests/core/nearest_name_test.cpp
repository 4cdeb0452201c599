// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/nearest_name.hpp"

#include <gtest/gtest.h>

namespace helixnav::core {
namespace {

TEST(NearestName, ProposesTheCandidateWithTheFewestEdits) {
  const std::vector<std::string> names{"large-loop", "sparse", "open-road", "orchard"};
  EXPECT_EQ(nearest_name("large_loop", names), "large-loop");
  EXPECT_EQ(nearest_name("spase", names), "sparse");
  EXPECT_EQ(nearest_name("orchards", names), "orchard");
  EXPECT_EQ(nearest_name("orchard", names), "orchard");
}

TEST(NearestName, CountsInsertionsDeletionsAndReplacements) {
  EXPECT_EQ(nearest_name("ab", {"abcd", "axb"}), "axb");  // 2 insertions against 1
  EXPECT_EQ(nearest_name("abcd", {"ab", "abxx"}), "ab");  // 2 and 2: the first
  EXPECT_EQ(nearest_name("", {"abc", "a"}), "a");
}

TEST(NearName, IsTheNearestUnlessItIsUnlike) {
  EXPECT_EQ(near_name("large_lop", {"large-loop", "sparse"}), "large-loop");
  EXPECT_EQ(near_name("jbcc", {"jcbb", "nearest"}), "jcbb");
  EXPECT_EQ(near_name("nosuch", {"long", "large-loop"}), "");
  EXPECT_EQ(near_name("foo", {"dlr", "plaza"}), "");
  EXPECT_EQ(near_name("search.particls", {"search.particles", "search.limit"}), "search.particles");
  EXPECT_EQ(near_name("search.foo", {"search.particles", "search.limit"}), "") << "the section alone is no likeness";
  EXPECT_EQ(near_name("x", {}), "");
}

TEST(NearestName, IsEmptyWithoutCandidates) { EXPECT_EQ(nearest_name("x", {}), ""); }

}  // namespace
}  // namespace helixnav::core
