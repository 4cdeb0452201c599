// SPDX-License-Identifier: BSD-3-Clause
#include "common/plan.hpp"

#include <gtest/gtest.h>

namespace helixnav::apps {
namespace {

std::size_t count_in(const std::string& text, const std::string& words) {
  std::size_t count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
  return count;
}

TEST(Plan, HasAxesWithTicksInMetres) {
  const std::string html = plan_html({-50.0, -10.0}, {150.0, 90.0}, "<path class=\"mark\"/>", "a map");
  EXPECT_EQ(count_in(html, "x [m]"), 1u) << html;
  EXPECT_EQ(count_in(html, "y [m]"), 1u) << html;
  EXPECT_EQ(count_in(html, "<span class=\"x\""), 5u) << html;
  EXPECT_NE(html.find(">\u221250</span>"), std::string::npos) << html;
  EXPECT_NE(html.find(">150</span>"), std::string::npos) << html;
  EXPECT_EQ(count_in(html, ">0</span>"), 2u) << html;
  EXPECT_NE(html.find("class=\"mark\""), std::string::npos) << html;
}

TEST(Plan, OfAPointOrALineHasRoomForTicks) {
  for (const Eigen::Vector2d& high_m : {Eigen::Vector2d(3.0, 4.0), Eigen::Vector2d(1003.0, 4.0)}) {
    const std::string html = plan_html({3.0, 4.0}, high_m, "", "a map");
    EXPECT_GE(count_in(html, "<span class=\"x\""), 1u) << html;
    EXPECT_GE(count_in(html, "<span class=\"y\""), 1u) << html;
    EXPECT_EQ(html.find("nan"), std::string::npos) << html;
  }
}

}  // namespace
}  // namespace helixnav::apps
