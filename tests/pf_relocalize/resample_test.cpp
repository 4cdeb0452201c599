// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/resample.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/chi2.hpp"

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
