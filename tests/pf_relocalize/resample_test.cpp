// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/resample.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::pf_relocalize {
namespace {

Particles cloud_with_weights(const std::vector<double>& weights) {
  Particles cloud;
  cloud.resize(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    cloud.set_pose(i, {static_cast<double>(i), 0.0, 0.0});
    cloud.log_weight[i] = std::log(weights[i]);
  }
  return cloud;
}

TEST(Resample, NormalisesWeightsFarBelowTheRangeOfADouble) {
  Particles cloud = cloud_with_weights({1.0, 3.0});
  for (double& lw : cloud.log_weight) lw -= 5000.0;
  EXPECT_NEAR(normalise(cloud), std::log(4.0) - 5000.0, 1e-9);
  EXPECT_NEAR(std::exp(cloud.log_weight[1]), 0.75, 1e-9);
  EXPECT_NEAR(effective_sample_size(cloud), 1.0 / (0.0625 + 0.5625), 1e-9);
}

TEST(Resample, LeavesTheParticlesAsTheyWereWhenNoWeightIsFinite) {
  Particles cloud = cloud_with_weights({0.0, 0.0});
  EXPECT_THROW(normalise(cloud), core::NumericalError);
  EXPECT_EQ(cloud.log_weight[0], -HUGE_VAL);
  cloud.log_weight[1] = std::nan("");
  EXPECT_THROW(normalise(cloud), core::NumericalError);
}

TEST(Resample, GivesEveryParticleTheFloorOrTheCeilingOfItsShare) {
  core::RandomStream random(1, "resample test");
  for (int run = 0; run < 200; ++run) {
    std::vector<double> weights(50);
    for (double& w : weights) w = std::pow(random.uniform(), 6);
    Particles cloud = cloud_with_weights(weights);
    normalise(cloud);
    const std::size_t m = 20 + random.below(200);
    std::vector<std::uint32_t> parents;
    systematic_parents(cloud, m, random.uniform(), parents);
    ASSERT_EQ(parents.size(), m);
    std::vector<int> count(weights.size(), 0);
    for (const std::uint32_t p : parents) ++count[p];
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double share = static_cast<double>(m) * std::exp(cloud.log_weight[i]);
      EXPECT_GE(count[i], std::floor(share - 1e-9));
      EXPECT_LE(count[i], std::ceil(share + 1e-9));
    }
  }
}

TEST(Resample, IsUnbiasedOverTheOffset) {
  Particles cloud = cloud_with_weights({0.1, 0.25, 0.05, 0.6});
  normalise(cloud);
  std::vector<std::uint32_t> parents;
  std::vector<double> mean(4, 0.0);
  const int offsets = 1000;
  for (int k = 0; k < offsets; ++k) {
    systematic_parents(cloud, 7, (k + 0.5) / offsets, parents);
    for (const std::uint32_t p : parents) mean[p] += 1.0 / offsets;
  }
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(mean[i], 7.0 * std::exp(cloud.log_weight[i]), 0.01);
}

TEST(Resample, KeepsPosesLatentsAndOrderOfTheParents) {
  Particles cloud = cloud_with_weights({0.5, 0.5, 0.0001});
  cloud.latent.assign(2, {7.0, 8.0, 9.0});
  Particles out;
  take_parents(cloud, {0, 0, 1, 2}, out);
  EXPECT_EQ(out.size(), 4U);
  EXPECT_EQ(out.x_m, (std::vector<double>{0.0, 0.0, 1.0, 2.0}));
  EXPECT_EQ(out.latent[1], (std::vector<double>{7.0, 7.0, 8.0, 9.0}));
  EXPECT_NEAR(out.log_weight[3], -std::log(4.0), 1e-15);
}

TEST(Resample, SampleSizeIsTheChiSquareQuantileOverTwiceTheError) {
  for (const std::size_t bins : {2U, 5U, 40U, 300U}) {
    const double exact = core::chi2_quantile(0.99, static_cast<int>(bins) - 1) / (2.0 * 0.05);
    EXPECT_NEAR(static_cast<double>(kld_sample_size(bins, 0.05)), exact, 0.02 * exact + 1.0) << bins;
  }
  EXPECT_EQ(kld_sample_size(1, 0.05), 1U);
}

TEST(Resample, CountsBinsAcrossTheOrigin) {
  Particles cloud;
  cloud.resize(4);
  cloud.set_pose(0, {-0.1, 0.1, 0.0});
  cloud.set_pose(1, {0.1, 0.1, 0.0});
  cloud.set_pose(2, {0.2, 0.2, 0.01});
  cloud.set_pose(3, {0.2, 0.2, -0.01});
  std::vector<std::uint64_t> keys;
  EXPECT_EQ(occupied_bins(cloud, {0, 1, 2, 3}, 0.5, 0.05, keys), 3U);
  EXPECT_EQ(occupied_bins(cloud, {1, 2}, 0.5, 0.05, keys), 1U);
}

}  // namespace
}  // namespace helixnav::pf_relocalize
