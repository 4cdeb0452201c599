// SPDX-License-Identifier: BSD-3-Clause
#include "noise/repeated_errors.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"

namespace helixnav::supervisor {
namespace {

Eigen::Vector2d drawn(double variance, core::RandomStream& random) {
  const double x = random.normal(0.0, std::sqrt(variance));
  const double y = random.normal(0.0, std::sqrt(variance));
  return {x, y};
}

/// Errors of variance `white` that are independent from look to look, plus one of variance `lasting` that each landmark
/// has for `scans` scans.
RepeatedErrors repeated(double white, double lasting, int landmarks, int scans) {
  core::RandomStream random(11, "repeated errors test");
  RepeatedErrors errors;
  for (int group = 0; group < landmarks; group += 10) {
    std::vector<Eigen::Vector2d> biases;
    for (int i = 0; i < 10; ++i) biases.push_back(drawn(lasting, random));
    for (int scan = 0; scan < scans; ++scan) {
      errors.next_scan();
      for (int i = 0; i < 10; ++i) {
        errors.add(group + i, biases[static_cast<std::size_t>(i)] + drawn(white, random));
      }
    }
  }
  return errors;
}

// 500 sums of two degrees of freedom: four standard deviations of their mean are 0.18 of it (1 false alarm in 16 000).
TEST(RepeatedErrors, IsTheScaleOfErrorsThatAreIndependent) {
  EXPECT_NEAR(repeated(1.0, 0.0, 500, 8).scale(), 1.0, 0.18);
  EXPECT_NEAR(repeated(0.25, 0.0, 500, 8).scale(), 0.25, 0.05);
}

TEST(RepeatedErrors, CountsWhatLastsEightTimes) { EXPECT_NEAR(repeated(0.1, 0.1, 500, 8).scale(), 0.9, 0.16); }

TEST(RepeatedErrors, NeedsEightLooksInOnePassage) {
  EXPECT_EQ(repeated(1.0, 0.0, 100, 7).weight(), 0.0);
  RepeatedErrors errors;
  for (int passage = 0; passage < 2; ++passage) {
    for (int look = 0; look < 7; ++look) {
      errors.next_scan();
      errors.add(0, {1.0, 0.0});
    }
    for (int scan = 0; scan < 30; ++scan) errors.next_scan();
  }
  EXPECT_EQ(errors.weight(), 0.0) << "the first passage has been forgotten";
}

}  // namespace
}  // namespace helixnav::supervisor
