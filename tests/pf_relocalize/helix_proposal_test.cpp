// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/helix_proposal.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"
#include "scatter_world.hpp"

namespace helixnav::pf_relocalize {
namespace {

constexpr SensorModel proposing_sensor{0.85, 2.5};

test::ScatterOptions small_prior() {
  test::ScatterOptions options;
  options.prior_sigma_m = 3.0;
  options.prior_sigma_rad = 6.0 * core::pi / 180.0;
  return options;
}

struct Draw {
  Particles cloud;
  std::size_t pairs = 0;
};

Draw draw(const ReferenceMap& map, const core::Scan& scan, const HelixOptions& options, std::size_t n,
          std::uint64_t seed) {
  ScanLikelihood likelihood(map, proposing_sensor);
  likelihood.set_scan(scan);
  HelixProposal proposal(map, likelihood, options);
  core::RandomStream random(seed, "draw");
  Draw result;
  result.pairs = proposal.pairs();
  result.cloud.latent.resize(static_cast<std::size_t>(map.latent_modes()));
  result.cloud.resize(n);
  proposal.allot(n, random.uniform());
  proposal.sample(result.cloud, 0, n, random);
  proposal.weigh(result.cloud, 0, n);
  return result;
}

/// Mean of exp(log_weight) and its standard error.
std::pair<double, double> mean_weight(const Particles& cloud) {
  double sum = 0.0, squares = 0.0;
  for (const double lw : cloud.log_weight) {
    sum += std::exp(lw);
    squares += std::exp(2.0 * lw);
  }
  const double n = static_cast<double>(cloud.size()), mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n)};
}

TEST(HelixProposal, WeightsThePriorToOneWithinFourStandardErrors) {
  // E_q[prior/q] = 1 holds only if q is the exact density of the whole mixture, crossing tubes included. Six runs, 4 σ:
  // false alarm 4e-4. Without the sum over tubes (q of the own tube only) the mean is several times too large.
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    test::ScatterWorld world(small_prior(), seed);
    const Draw drawn = draw(world.map, world.scan(), {}, 20000, seed);
    const auto [mean, error] = mean_weight(drawn.cloud);
    EXPECT_GT(drawn.pairs, 10U);
    EXPECT_NEAR(mean, 1.0, 4.0 * error) << seed;
    EXPECT_LT(error, 0.05);
  }
}

TEST(HelixProposal, WeightsThePriorToOneWithLatentModes) {
  test::ScatterWorld world(small_prior(), 3);
  world.map.latent.resize(world.map.latent.rows(), 2);
  core::RandomStream random(1, "modes");
  for (Eigen::Index k = 0; k < world.map.latent.size(); ++k) world.map.latent.data()[k] = random.normal(0.0, 0.2);
  world.map.prior_by_latent = (Eigen::Matrix<double, 3, 2>() << 0.5, 0.2, -0.4, 0.3, 0.02, 0.01).finished();
  const auto [mean, error] = mean_weight(draw(world.map, world.scan(), {}, 20000, 1).cloud);
  EXPECT_NEAR(mean, 1.0, 4.0 * error);
  EXPECT_LT(error, 0.05);
}

TEST(HelixProposal, PutsEveryHelixParticleWhereItsObservationMeetsALandmark) {
  test::ScatterWorld world({}, 4);
  core::Scan scan = world.scan();
  scan.T_robot_sensor = core::Pose2(3.78, 0.5, 0.2);
  HelixOptions options;
  options.prior_share = 0.0;
  const Particles cloud = draw(world.map, scan, options, 3000, 5).cloud;
  for (std::size_t p = 0; p < cloud.size(); ++p) {
    double best = HUGE_VAL;  // squared distance in σ to the nearest explanation
    for (const core::Observation& z : scan.observations) {
      const core::LocatedLandmark m = core::locate_landmark(z, cloud.pose(p), scan.T_robot_sensor);
      const Eigen::Matrix2d S = m.G_z * z.R * m.G_z.transpose() + 0.09 * Eigen::Matrix2d::Identity();
      for (const core::PointGaussian& landmark : world.map.landmarks) {
        const Eigen::Vector2d d = m.point_world_m - landmark.mean_m;
        best = std::min(best, d.dot(S.inverse() * d));
      }
    }
    EXPECT_LT(best, 25.0);
    EXPECT_LE(std::abs(core::wrap_to_pi(cloud.heading_rad[p] - world.map.prior.mean.heading_rad)),
              3.5 * world.options.prior_sigma_rad + 1e-3);
  }
}

TEST(HelixProposal, DrawsFromTheDensityThatItReports) {
  // E_q[f/q] = ∫f for any f inside the support: f = 1 on a box about the truth. Shows that q is right locally; the test
  // of the whole prior could hide errors that cancel.
  test::ScatterWorld world(small_prior(), 6);
  const core::Scan scan = world.scan();
  ScanLikelihood likelihood(world.map, proposing_sensor);
  likelihood.set_scan(scan);
  HelixProposal proposal(world.map, likelihood, {});
  core::RandomStream random(2, "density");
  Particles cloud;
  const std::size_t n = 50000;
  cloud.resize(n);
  proposal.allot(n, random.uniform());
  proposal.sample(cloud, 0, n, random);
  std::vector<double> log_q(n);
  proposal.log_proposal(cloud, 0, n, log_q.data());
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const core::Pose2 e = core::between(world.truth, cloud.pose(i));
    if (std::abs(e.x_m) > 1.0 || std::abs(e.y_m) > 1.0 || std::abs(e.heading_rad) > 0.05) continue;
    sum += std::exp(-log_q[i]);
    squares += std::exp(-2.0 * log_q[i]);
  }
  const double mean = sum / static_cast<double>(n);
  const double error = std::sqrt(squares) / static_cast<double>(n);
  EXPECT_NEAR(mean, 2.0 * 2.0 * 0.1, 4.0 * error);
  EXPECT_LT(error, 0.1 * mean);
}

TEST(HelixProposal, FallsBackOnThePriorWhenNothingSeenFitsIt) {
  test::ScatterWorld world(small_prior(), 7);
  core::Scan scan = world.scan();
  scan.observations.clear();
  const Draw drawn = draw(world.map, scan, {}, 2000, 3);
  EXPECT_EQ(drawn.pairs, 0U);
  for (const double lw : drawn.cloud.log_weight) EXPECT_NEAR(lw, 0.0, 1e-9);
}

TEST(HelixProposal, RefusesSharesOutsideZeroToOne) {
  test::ScatterWorld world(small_prior(), 8);
  HelixOptions options;
  options.prior_share = 1.5;
  EXPECT_THROW(draw(world.map, world.scan(), options, 10, 1), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::pf_relocalize
