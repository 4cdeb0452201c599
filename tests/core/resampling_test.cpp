// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/resampling.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::core {
namespace {

std::vector<double> logarithms(const std::vector<double>& weights) {
  std::vector<double> log_weight;
  for (const double w : weights) log_weight.push_back(std::log(w));
  return log_weight;
}

TEST(Resampling, NormalisesWeightsFarBelowTheRangeOfADouble) {
  std::vector<double> cloud = logarithms({1.0, 3.0});
  for (double& lw : cloud) lw -= 5000.0;
  EXPECT_NEAR(normalise(cloud), std::log(4.0) - 5000.0, 1e-9);
  EXPECT_NEAR(std::exp(cloud[1]), 0.75, 1e-9);
  EXPECT_NEAR(effective_sample_size(cloud), 1.0 / (0.0625 + 0.5625), 1e-9);
}

TEST(Resampling, LeavesTheWeightsAsTheyWereWhenNoWeightIsFinite) {
  std::vector<double> cloud = logarithms({0.0, 0.0});
  EXPECT_THROW(normalise(cloud), NumericalError);
  EXPECT_EQ(cloud[0], -HUGE_VAL);
  cloud[1] = std::nan("");
  EXPECT_THROW(normalise(cloud), NumericalError);
}

TEST(Resampling, GivesEveryParticleTheFloorOrTheCeilingOfItsShare) {
  RandomStream random(1, "resample test");
  for (int run = 0; run < 200; ++run) {
    std::vector<double> weights(50);
    for (double& w : weights) w = std::pow(random.uniform(), 6);
    std::vector<double> cloud = logarithms(weights);
    normalise(cloud);
    const std::size_t m = 20 + random.below(200);
    std::vector<std::uint32_t> parents;
    systematic_parents(cloud, m, random.uniform(), parents);
    ASSERT_EQ(parents.size(), m);
    std::vector<int> count(weights.size(), 0);
    for (const std::uint32_t p : parents) ++count[p];
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double share = static_cast<double>(m) * std::exp(cloud[i]);
      EXPECT_GE(count[i], std::floor(share - 1e-9));
      EXPECT_LE(count[i], std::ceil(share + 1e-9));
    }
  }
}

TEST(Resampling, IsUnbiasedOverTheOffset) {
  std::vector<double> cloud = logarithms({0.1, 0.25, 0.05, 0.6});
  normalise(cloud);
  std::vector<std::uint32_t> parents;
  std::vector<double> mean(4, 0.0);
  const int offsets = 1000;
  for (int k = 0; k < offsets; ++k) {
    systematic_parents(cloud, 7, (k + 0.5) / offsets, parents);
    for (const std::uint32_t p : parents) mean[p] += 1.0 / offsets;
  }
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(mean[i], 7.0 * std::exp(cloud[i]), 0.01);
}

}  // namespace
}  // namespace helixnav::core
