// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/modes.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"
#include "helixnav/core/resampling.hpp"

namespace helixnav::pf_relocalize {
namespace {

/// `n` particles about a pose with the given σ, each of weight `weight`.
void add(Particles& cloud, std::size_t n, const core::Pose2& centre, const Eigen::Vector3d& sigma, double weight,
         core::RandomStream& random) {
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = cloud.size();
    cloud.resize(i + 1);
    const Eigen::Vector3d noise(random.normal(), random.normal(), random.normal());
    cloud.set_pose(i, core::Pose2(centre.vector() + sigma.cwiseProduct(noise)));
    cloud.log_weight[i] = std::log(weight);
  }
}

TEST(Modes, FindsEachClusterWithItsMassMeanAndSpread) {
  core::RandomStream random(1, "modes");
  Particles cloud;
  const Eigen::Vector3d sigma(0.3, 0.2, 0.015);
  add(cloud, 4000, {10.0, 5.0, 3.14}, sigma, 1.0, random);  // headings on both sides of the wrap
  add(cloud, 4000, {16.0, 5.0, 3.14}, sigma, 0.5, random);
  add(cloud, 4000, {10.0, 5.0, 2.5}, sigma, 0.25, random);
  core::normalise(cloud.log_weight);
  std::vector<std::uint8_t> taken;
  std::vector<Mode> modes;
  find_modes(cloud, {}, 8, 1e-3, taken, modes);
  ASSERT_EQ(modes.size(), 3U);
  EXPECT_NEAR(modes[0].mass, 1.0 / 1.75, 1e-3);
  EXPECT_NEAR(modes[1].mass, 0.5 / 1.75, 1e-3);
  EXPECT_NEAR(modes[2].mass, 0.25 / 1.75, 1e-3);
  EXPECT_LT((modes[0].pose.mean.position_m() - Eigen::Vector2d(10.0, 5.0)).norm(), 0.03);
  EXPECT_NEAR(core::wrap_to_pi(modes[0].pose.mean.heading_rad - 3.14), 0.0, 2e-3);
  EXPECT_NEAR(std::sqrt(modes[0].pose.covariance(0, 0)), 0.3, 0.015);
  EXPECT_NEAR(std::sqrt(modes[0].pose.covariance(2, 2)), 0.015, 0.001);
}

TEST(Modes, MomentsOfTheWholeCloudDoNotBreakAtTheWrap) {
  core::RandomStream random(2, "moments");
  Particles cloud;
  add(cloud, 20000, {1.0, 2.0, 3.1}, {0.5, 0.5, 0.2}, 1.0, random);
  core::normalise(cloud.log_weight);
  const core::PoseGaussian moments = cloud_moments(cloud);
  EXPECT_NEAR(core::wrap_to_pi(moments.mean.heading_rad - 3.1), 0.0, 0.01);
  EXPECT_NEAR(std::sqrt(moments.covariance(2, 2)), 0.2, 0.01);
  EXPECT_NEAR(std::sqrt(moments.covariance(0, 0)), 0.5, 0.02);
}

TEST(Modes, StopsAtTheNumberAskedFor) {
  core::RandomStream random(3, "many");
  Particles cloud;
  for (int k = 0; k < 20; ++k) add(cloud, 5, {10.0 * k, 0.0, 0.0}, {0.1, 0.1, 0.01}, 1.0, random);
  core::normalise(cloud.log_weight);
  std::vector<std::uint8_t> taken;
  std::vector<Mode> modes;
  find_modes(cloud, {}, 6, 1e-3, taken, modes);
  EXPECT_EQ(modes.size(), 6U);
}

}  // namespace
}  // namespace helixnav::pf_relocalize
