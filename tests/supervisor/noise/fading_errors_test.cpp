// SPDX-License-Identifier: BSD-3-Clause
#include "noise/fading_errors.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"

namespace helixnav::supervisor {
namespace {

/// Squared normalised errors of noise `scale` times the assumed variance, `wrong` of them from wrong pairs.
FadingErrors errors_of(double scale, double wrong, int count) {
  core::RandomStream random(7, "fading errors test");
  FadingErrors errors(1.0 - 1e-6);
  for (int i = 0; i < count; ++i) {
    errors.fade();
    const double x = random.normal(0.0, std::sqrt(scale));
    const double y = random.normal(0.0, std::sqrt(scale));
    errors.add(random.uniform(0.0, 1.0) < wrong ? 1e4 : x * x + y * y, 1.0);
  }
  return errors;
}

// Four standard deviations of ln scale: 1 false alarm in 16 000 for each.
TEST(FadingErrors, ScaleIsThatOfTheNoise) {
  for (const double scale : {1.0 / 25.0, 0.25, 1.0, 4.0, 16.0}) {
    const FadingErrors errors = errors_of(scale, 0.0, 4000);
    EXPECT_NEAR(std::log(errors.scale() / scale), 0.0, 4.0 * errors.log_sigma()) << scale;
  }
}

TEST(FadingErrors, ATenthOfWrongPairsMovesItByAFifthAtMost) {
  EXPECT_NEAR(errors_of(4.0, 0.1, 4000).scale(), 4.0, 0.8);
}

TEST(FadingErrors, TheMeanOfGaussianErrorsIsTheirScaleAndThatOfHeavyTailsMore) {
  EXPECT_NEAR(errors_of(0.25, 0.0, 4000).mean_scale(), 0.25, 0.02);
  const FadingErrors heavy = errors_of(0.25, 0.05, 4000);
  EXPECT_GT(heavy.mean_scale(), 2.0 * heavy.scale());
}

TEST(FadingErrors, NothingIsKnownWithoutErrors) {
  const FadingErrors errors(0.99);
  EXPECT_EQ(errors.scale(), 1.0);
  EXPECT_EQ(errors.mean_scale(), 1.0);
  EXPECT_TRUE(std::isinf(errors.log_sigma()));
}

}  // namespace
}  // namespace helixnav::supervisor
