// SPDX-License-Identifier: BSD-3-Clause
// The compressed filter is the full filter, to round-off.
#include <gtest/gtest.h>

#include "random_program.hpp"

namespace helixnav::cekf {
namespace {

class Equality : public testing::TestWithParam<Retraction> {};

TEST_P(Equality, HoldsTo1em10InOnePhase) {
  for (const std::uint64_t seed : {1u, 2u}) {
    RandomProgram program(seed, {GetParam(), 220, 0, seed == 2});
    for (int k = 0; k < 300; ++k) program.step();
    program.switch_region_randomly();  // a phase with a passive part
    for (int k = 0; k < 200; ++k) program.step();
    const Differences d = compare(program.filter, program.oracle);
    EXPECT_LE(d.covariance, 1e-10) << "seed " << seed;
    EXPECT_LE(d.mean, 1e-10) << "seed " << seed;
    RecordProperty("covariance", std::to_string(d.covariance));
    std::printf("one phase: mean %.1e cov %.1e, %d landmarks, lazy %d, removed %d\n", d.mean, d.covariance,
                program.filter.mapped_count(), program.lazy_activations, program.removed);
  }
}

TEST_P(Equality, HoldsTo1em7OverFiftySwitches) {
  RandomProgram program(3, {GetParam(), 220, 18, false});
  Differences worst;
  for (int k = 0; k < 1000; ++k) {
    program.step();
    if (k % 50 != 0 || program.filter.mapped_count() == 0) continue;
    const Differences d = compare(program.filter, program.oracle);
    worst.mean = std::max(worst.mean, d.mean);
    worst.covariance = std::max(worst.covariance, d.covariance);
  }
  EXPECT_GE(program.switches, 50);
  EXPECT_GE(program.lazy_activations, 50);
  EXPECT_GE(program.filter.mapped_count(), 100);
  EXPECT_LE(worst.covariance, 1e-7);
  EXPECT_LE(worst.mean, 1e-7);
  std::printf("switches %d: mean %.1e cov %.1e, %d landmarks, lazy %d, removed %d\n", program.switches, worst.mean,
              worst.covariance, program.filter.mapped_count(), program.lazy_activations, program.removed);
}

INSTANTIATE_TEST_SUITE_P(BothRetractions, Equality, testing::Values(Retraction::standard, Retraction::right_invariant),
                         [](const auto& tested) {
                           return tested.param == Retraction::standard ? "Standard" : "RightInvariant";
                         });

}  // namespace
}  // namespace helixnav::cekf
