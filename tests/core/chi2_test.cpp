// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/chi2.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "helixnav/core/errors.hpp"

namespace helixnav::core {
namespace {

// Printed tables of the χ² distribution give three decimals.
TEST(Chi2, QuantilesEqualTheTabulatedValues) {
  constexpr double tabulated = 5.1e-4;
  EXPECT_NEAR(chi2_quantile(0.95, 1), 3.841, tabulated);
  EXPECT_NEAR(chi2_quantile(0.99, 1), 6.635, tabulated);
  EXPECT_NEAR(chi2_quantile(0.95, 2), 5.991, tabulated);
  EXPECT_NEAR(chi2_quantile(0.99, 2), 9.210, tabulated);
  EXPECT_NEAR(chi2_quantile(0.999, 2), 13.816, tabulated);
  EXPECT_NEAR(chi2_quantile(0.95, 3), 7.815, tabulated);
  EXPECT_NEAR(chi2_quantile(0.99, 3), 11.345, tabulated);
  EXPECT_NEAR(chi2_quantile(0.05, 10), 3.940, tabulated);
  EXPECT_NEAR(chi2_quantile(0.95, 10), 18.307, tabulated);
  EXPECT_NEAR(chi2_quantile(0.025, 100), 74.222, tabulated);
  EXPECT_NEAR(chi2_quantile(0.975, 100), 129.561, tabulated);
}

TEST(Chi2, TwoDegreesOfFreedomHaveAClosedForm) {
  for (const double p : {1e-6, 0.1, 0.5, 0.9, 0.999999}) {
    EXPECT_NEAR(chi2_quantile(p, 2), -2.0 * std::log1p(-p), 1e-9);
  }
  for (const double x : {0.0, 0.3, 5.0, 40.0}) EXPECT_NEAR(chi2_cdf(x, 2), -std::expm1(-0.5 * x), 1e-14);
}

TEST(Chi2, CdfInvertsTheQuantile) {
  for (const int dof : {1, 2, 3, 7, 50, 1000, 30000}) {
    for (const double p : {0.001, 0.3, 0.95, 0.9999}) EXPECT_NEAR(chi2_cdf(chi2_quantile(p, dof), dof), p, 1e-9);
  }
}

TEST(Chi2, RefusesWhatIsNoProbabilityOrNoDegreeOfFreedom) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double p : {0.0, 1.0, -0.1, 1.1, nan}) EXPECT_THROW(chi2_quantile(p, 2), PreconditionError);
  EXPECT_THROW(chi2_quantile(0.5, 0), PreconditionError);
  EXPECT_THROW(chi2_cdf(-1.0, 2), PreconditionError);
  EXPECT_THROW(chi2_cdf(nan, 2), PreconditionError);
  EXPECT_THROW(chi2_cdf(1.0, 0), PreconditionError);
}

}  // namespace
}  // namespace helixnav::core
