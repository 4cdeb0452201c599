// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "campaign.hpp"
#include "scenario_study.hpp"

namespace helixnav::cekf {
namespace {

const int runs = support::campaign_runs(30);
constexpr std::uint64_t first_seed = 740001;  // not used by anybody while the filter was developed

// The errors of one run are strongly correlated over the last quarter, so that each run counts as one draw of χ²₃; the
// NIS of all updates are independent. Both bands: false alarm 1 % (2.58 σ).
void expect_consistent(const StudySums& sums) {
  EXPECT_NEAR(sums.mean_nees(), 3.0, 2.58 * std::sqrt(6.0 / runs));
  EXPECT_NEAR(sums.nis_per_dof(), 1.0, 2.58 * std::sqrt(2.0 / sums.nis_dof));
}

TEST(ScenarioCampaign, CircuitLeavesTheDefaultFilterConsistent) {
  expect_consistent(drive_scenario("circuit", {}, first_seed, runs));
}

TEST(ScenarioCampaign, CircuitWithLargeNoiseLeavesTheDefaultFilterConsistent) {
  expect_consistent(drive_scenario("circuit-large-noise", {}, first_seed, runs));
}

}  // namespace
}  // namespace helixnav::cekf
