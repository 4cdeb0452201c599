// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "circuit_study.hpp"

namespace helixnav::cekf {
namespace {

Consistency thirty_runs(Retraction retraction, const CircuitNoise& noise) {
  Consistency sum;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) sum.add(drive_circuit(retraction, noise, seed));
  return sum;
}

// Errors of one run are strongly correlated over the last quarter, so that 30 runs count as 30 draws of χ²₃:
// mean in 3 ± 2.58·√(6/30), false alarm 1 %. The 100-run figures are printed by bench/consistency_study.
constexpr double low = 3.0 - 2.58 * 0.4472;
constexpr double high = 3.0 + 2.58 * 0.4472;

TEST(Consistency, OfTheRightInvariantFilterHoldsWithModerateNoise) {
  const double nees = thirty_runs(Retraction::right_invariant, moderate_noise()).mean_nees();
  EXPECT_GE(nees, low);
  EXPECT_LE(nees, high);
}

TEST(Consistency, OfTheRightInvariantFilterHoldsWithLargeNoiseWhereTheStandardOneIsWorse) {
  const double nees = thirty_runs(Retraction::right_invariant, large_noise()).mean_nees();
  EXPECT_GE(nees, low);
  EXPECT_LE(nees, high);
  EXPECT_GT(thirty_runs(Retraction::standard, large_noise()).mean_nees(), nees);
}

}  // namespace
}  // namespace helixnav::cekf
