// SPDX-License-Identifier: BSD-3-Clause
#include "search/residual_scale.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"

namespace helixnav::relocalize {
namespace {

double chi2_of(int dof, core::RandomStream& random) {
  double sum = 0.0;
  for (int i = 0; i < dof; ++i) {
    const double normal = random.normal();
    sum += normal * normal;
  }
  return sum;
}

TEST(ResidualScale, IsNoLessThanWhatIsCounted) {
  core::RandomStream random(1);
  constexpr int draws = 20000;
  for (const double ratio : {0.1, 0.3, 0.6}) {
    int counted = 0;
    for (int i = 0; i < draws; ++i) counted += chi2_of(7, random) < ratio * chi2_of(11, random) ? 1 : 0;
    const double bound = std::exp(ln_chance_of_smaller({ratio, 7.0}, {1.0, 11.0}));
    const double share = static_cast<double>(counted) / draws;
    EXPECT_LE(share, bound + 4.0 * std::sqrt(bound / draws)) << ratio;
    EXPECT_GE(share, 0.1 * std::min(1.0, bound)) << ratio << ": near what it bounds";
  }
}

TEST(ResidualScale, SaysNothingWhereNothingIsLeft) {
  EXPECT_EQ(ln_chance_of_smaller({0.0, 7.0}, {0.0, 7.0}), 0.0);
  EXPECT_EQ(ln_chance_of_smaller({5.0, 7.0}, {1.0, 7.0}), 0.0) << "it is not smaller";
  EXPECT_LT(ln_chance_of_smaller({0.66, 63.0}, {66.0, 63.0}), -90.0);
}

}  // namespace
}  // namespace helixnav::relocalize
