// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "campaign.hpp"
#include "circuit_study.hpp"

namespace helixnav::cekf {
namespace {

Consistency thirty_runs(Retraction retraction, const CircuitNoise& noise) {
  Consistency sum;
  for (const std::uint64_t seed : support::campaign_seeds(1, 30)) sum.add(drive_circuit(retraction, noise, seed));
  return sum;
}

// Errors of one run are strongly correlated over the last quarter, so that 30 runs count as 30 draws of χ²₃:
// mean in 3 ± 2.58·√(6/30), false alarm 1 %. The 100-run figures are printed by bench/consistency_study.
const double low = 3.0 - 2.58 * std::sqrt(6.0 / support::campaign_runs(30));
const double high = 3.0 + 2.58 * std::sqrt(6.0 / support::campaign_runs(30));

TEST(ConsistencyCampaign, OfTheRightInvariantFilterHoldsWithModerateNoise) {
  const double nees = thirty_runs(Retraction::right_invariant, moderate_noise()).mean_nees();
  EXPECT_GE(nees, low);
  EXPECT_LE(nees, high);
}

TEST(ConsistencyCampaign, OfTheRightInvariantFilterHoldsWithLargeNoiseWhereTheStandardOneIsWorse) {
  const double nees = thirty_runs(Retraction::right_invariant, large_noise()).mean_nees();
  EXPECT_GE(nees, low);
  EXPECT_LE(nees, high);
  const double standard = thirty_runs(Retraction::standard, large_noise()).mean_nees();
  if (support::whole_campaign) {
    EXPECT_GT(standard, nees);
  }
}

}  // namespace
}  // namespace helixnav::cekf
