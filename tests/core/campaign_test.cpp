// SPDX-License-Identifier: BSD-3-Clause
#include "campaign.hpp"

#include <gtest/gtest.h>

namespace helixnav::support {
namespace {

TEST(CampaignBands, OfCountsLeaveNoMoreThanTheFalseAlarmOutside) {
  const Band band = count_band(80, 0.63, 1e-3);  // sums of the binomial distribution: 3.6e-4 below 36, 3.2e-4 above 64
  EXPECT_EQ(band.low, 36);
  EXPECT_EQ(band.high, 64);
}

TEST(CampaignBands, OfOneRunHoldBothItsOutcomes) {
  const Band band = count_band(1, 0.63, 1e-3);
  EXPECT_EQ(band.low, 0);
  EXPECT_EQ(band.high, 1);
}

TEST(CampaignBands, OfChiSquareNarrowWithTheNumberOfRuns) {
  const Band one = chi2_band(1, 2, 0.01);  // χ²₂ is exponential with mean 2
  EXPECT_NEAR(one.low, -2.0 * std::log1p(-0.005), 1e-9);
  EXPECT_NEAR(one.high, -2.0 * std::log(0.005), 1e-9);
  const Band many = chi2_band(100, 2, 0.01);
  EXPECT_GT(many.low / 100, one.low);
  EXPECT_LT(many.high / 100, one.high);
}

TEST(CampaignSeeds, AreAllOrUnderASanitizerTheFirst) {
  const std::vector<std::uint64_t> seeds = campaign_seeds(7, 5);
  ASSERT_EQ(seeds.size(), whole_campaign ? 5u : 1u);
  EXPECT_EQ(seeds.front(), 7u);
  EXPECT_EQ(seeds.back(), whole_campaign ? 11u : 7u);
}

}  // namespace
}  // namespace helixnav::support
