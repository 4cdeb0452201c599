// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/relocalizer.hpp"

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/resampling.hpp"
#include "scatter_world.hpp"

namespace {
std::atomic<std::size_t> allocations{0};
}

// Counts what the whole program allocates, so that a test can require "nothing".
void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size == 0 ? 1 : size);
}
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // GCC sees only one half of the pair
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
#pragma GCC diagnostic pop

namespace helixnav::pf_relocalize {
namespace {

using test::ScatterOptions;
using test::ScatterWorld;

RelocalizerOptions options_with(std::size_t particles, unsigned threads = 1) {
  RelocalizerOptions options;
  options.sensor = {0.85, 2.0};
  options.most_particles = particles;
  options.least_particles = std::min<std::size_t>(particles, 1000);
  options.threads = threads;
  return options;
}

core::Scan first_scan(ScatterWorld& world) {
  core::Scan scan = world.scan();
  while (scan.observations.empty()) scan = world.scan();
  return scan;
}

/// Prior, likelihood and normaliser on a grid of poses: the filter's first posterior without sampling.
struct GridPosterior {
  double evidence = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  // relative to the prior's mean
};

GridPosterior grid_posterior(const ReferenceMap& map, const core::Scan& scan, const SensorModel& sensor) {
  const int n = 81, m = 61;
  const Eigen::Vector3d sigma = map.prior.covariance.diagonal().cwiseSqrt();
  const double d_xy = 10.0 * sigma[0] / n, d_heading = 10.0 * sigma[2] / m;
  ScanLikelihood likelihood(map, sensor);
  likelihood.set_scan(scan);
  Particles cell;
  cell.resize(static_cast<std::size_t>(m));
  std::vector<double> log_ratio(static_cast<std::size_t>(m));
  GridPosterior posterior;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < m; ++k) {
        cell.set_pose(static_cast<std::size_t>(k),
                      {map.prior.mean.x_m + (i - n / 2) * d_xy, map.prior.mean.y_m + (j - n / 2) * d_xy,
                       map.prior.mean.heading_rad + (k - m / 2) * d_heading});
      }
      likelihood.evaluate(cell, 0, cell.size(), log_ratio.data());
      for (int k = 0; k < m; ++k) {
        const Eigen::Vector3d d((i - n / 2) * d_xy, (j - n / 2) * d_xy, (k - m / 2) * d_heading);
        const double w = std::exp(-0.5 * d.cwiseQuotient(sigma).squaredNorm() + log_ratio[static_cast<std::size_t>(k)]);
        posterior.evidence += w;
        posterior.mean += w * d;
      }
    }
  }
  posterior.mean /= posterior.evidence;
  posterior.evidence *= d_xy * d_xy * d_heading / (std::pow(2.0 * core::pi, 1.5) * sigma.prod());
  return posterior;
}

TEST(Relocalizer, AgreesWithBayesRuleOnAGridOfPosesAfterTheFirstScan) {
  // A crowded and a lonely candidate under a wide prior: a start without mirror-corrected weights favours the crowd.
  ScatterOptions world_options;
  world_options.prior_sigma_m = 2.0;
  world_options.prior_sigma_rad = 0.1;
  world_options.map_sigma_m = 0.6;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    ScatterWorld world(world_options, seed);
    core::Scan scan = first_scan(world);
    if (scan.observations.size() > 3) scan.observations.resize(3);
    RelocalizerOptions options = options_with(30000);
    const GridPosterior exact = grid_posterior(world.map, scan, options.sensor);
    const Relocalizer search(world.map, scan, options, seed);
    const CloudState& state = search.state();
    ASSERT_GT(state.effective_size, 300.0);
    const Particles& drawn = search.weighted_particles();
    EXPECT_EQ(drawn.size(), state.particles);
    EXPECT_DOUBLE_EQ(core::effective_sample_size(drawn.log_weight), state.effective_size);
    const double error = 4.0 / std::sqrt(state.effective_size);  // 4 σ; 12 numbers: false alarm 1e-3
    EXPECT_NEAR(std::exp(state.log_evidence) / exact.evidence, 1.0, 2.0 * error) << seed;
    const Eigen::Vector3d sigma = state.cloud.covariance.diagonal().cwiseSqrt();
    const Eigen::Vector3d mean = state.cloud.mean.vector() - world.map.prior.mean.vector();
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean[k], exact.mean[k], error * sigma[k]) << seed << " " << k;
  }
}

/// Fraction of seeds for which the cloud is right when the paper's rule first holds.
double share_right(int runs, std::uint64_t first_seed, const RelocalizerOptions& options) {
  int right = 0;
  for (int run = 0; run < runs; ++run) {
    ScatterWorld world({}, first_seed + static_cast<std::uint64_t>(run));
    Relocalizer search(world.map, first_scan(world), options, static_cast<std::uint64_t>(run));
    for (int scan = 0; scan < 12; ++scan) {
      core::Odometry motion = world.drive();
      search.step(motion, world.scan());
      motion.covariance *= 3.0;  // THEORY §3.5: std < 2·√3·q
      if (!meets_paper_rule(search.state(), motion)) continue;
      right += world.is_right(search.state().cloud.mean) ? 1 : 0;
      break;
    }
  }
  return static_cast<double>(right) / runs;
}

TEST(Relocalizer, ConvergesOnHelicesAsOftenAsMeasuredAndOftenerThanFromThePrior) {
  // Prior 10 m / 10°, spacing 8 m, as in THEORY §3.5, with few particles so that the band has two sides. Shares over
  // 1000 other seeds: see the constants; the band is ±3.3 binomial σ of 100 runs (false alarm 1e-3 each).
  RelocalizerOptions options = options_with(500);
  options.motion_noise_scale = 1.0;
  const double helix = share_right(100, 5000, options);
  options.helix.prior_share = 1.0;
  const double gauss = share_right(100, 5000, options);
  const double helix_measured = 0.913, gauss_measured = 0.565;
  EXPECT_NEAR(helix, helix_measured, 3.3 * std::sqrt(helix_measured * (1.0 - helix_measured) / 100.0));
  EXPECT_NEAR(gauss, gauss_measured, 3.3 * std::sqrt(gauss_measured * (1.0 - gauss_measured) / 100.0));
}

TEST(Relocalizer, GivesTheSameBytesForAnyNumberOfThreadsAndAnotherSeedOthers) {
  const auto run = [](unsigned threads, std::uint64_t seed) {
    ScatterWorld world({}, 3);
    Relocalizer search(world.map, first_scan(world), options_with(3000, threads), seed);
    for (int k = 0; k < 6; ++k) {
      const core::Odometry motion = world.drive();
      search.step(motion, world.scan());
    }
    std::vector<double> bytes = search.particles().x_m;
    bytes.insert(bytes.end(), search.particles().heading_rad.begin(), search.particles().heading_rad.end());
    bytes.push_back(search.state().log_evidence);
    return bytes;
  };
  const std::vector<double> one = run(1, 5);
  for (const unsigned threads : {2U, 3U, 8U}) {
    const std::vector<double> many = run(threads, 5);
    ASSERT_EQ(one.size(), many.size());
    EXPECT_EQ(std::memcmp(one.data(), many.data(), one.size() * sizeof(double)), 0) << threads;
  }
  EXPECT_NE(one, run(1, 6));
}

TEST(Relocalizer, AllocatesNothingInAStep) {
  ScatterWorld world({}, 4);
  Relocalizer search(world.map, first_scan(world), options_with(3000, 2), 1);
  std::vector<core::Odometry> motions;
  std::vector<core::Scan> scans;
  for (int k = 0; k < 40; ++k) {
    motions.push_back(world.drive());
    scans.push_back(world.scan());
  }
  for (std::size_t k = 0; k < 5; ++k) search.step(motions[k], scans[k]);
  const std::size_t before = allocations;
  for (std::size_t k = 5; k < 40; ++k) search.step(motions[k], scans[k]);
  EXPECT_EQ(allocations - before, 0U);
}

TEST(Relocalizer, AdaptsTheNumberOfParticlesBetweenFloorAndCeiling) {
  ScatterWorld world({}, 5);
  Relocalizer search(world.map, first_scan(world), options_with(8000), 1);
  EXPECT_EQ(search.state().particles, 8000U);
  for (int k = 0; k < 8; ++k) {
    const core::Odometry motion = world.drive();
    search.step(motion, world.scan());
  }
  EXPECT_LT(search.state().particles, 3000U);
  EXPECT_GE(search.state().particles, 1000U);
}

/// Starts on a map and drives; returns the outcome of the search within 20 scans.
SearchOutcome search_outcome(ScatterWorld& world, const ReferenceMap& map, bool clutter_only, std::uint64_t seed) {
  const auto scan = [&] {
    if (clutter_only) world.landmarks.clear();
    return first_scan(world);
  };
  Relocalizer search(map, scan(), options_with(3000), seed);
  SearchOutcome outcome = SearchOutcome::searching;
  for (int k = 0; k < 20 && outcome == SearchOutcome::searching; ++k) {
    const core::Odometry motion = world.drive();
    search.step(motion, scan());
    outcome = judge_search(search.state());
  }
  return outcome;
}

TEST(Relocalizer, SaysNothingHereOnGroundWithoutAnyLandmarkOfTheMap) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    ScatterWorld world({}, seed);
    const SearchOutcome outcome = search_outcome(world, world.map, true, seed);
    EXPECT_TRUE(outcome == SearchOutcome::nothing_here || outcome == SearchOutcome::timed_out) << seed;
  }
}

TEST(Relocalizer, MeetsItsGateOnTheMapOfAnotherCrowdedPlaceSoThatTheGateIsNoEvidence) {
  // Every scan counts the same chance matches again (PROTOTYPE §0, point 3): hence the constellation test decides.
  int met = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    ScatterWorld here({}, seed);
    ReferenceMap elsewhere = ScatterWorld({}, seed + 100).map;
    elsewhere.prior = here.map.prior;
    met += search_outcome(here, elsewhere, false, seed) == SearchOutcome::gate_met ? 1 : 0;
  }
  EXPECT_GE(met, 5);
}

TEST(Relocalizer, HoldsLatentModesOfTheMap) {
  ScatterWorld world({}, 8);
  world.map.latent = Eigen::MatrixXd::Constant(world.map.latent.rows(), 1, 0.1);
  world.map.prior_by_latent = Eigen::MatrixXd::Zero(3, 1);
  Relocalizer search(world.map, first_scan(world), options_with(8000), 1);
  for (int k = 0; k < 4; ++k) {
    const core::Odometry motion = world.drive();
    search.step(motion, world.scan());
  }
  EXPECT_TRUE(world.is_right(search.state().modes.front().pose.mean));
}

TEST(Relocalizer, RefusesOptionsOutOfRange) {
  ScatterWorld world({}, 9);
  RelocalizerOptions options = options_with(1000);
  options.least_particles = 2000;
  EXPECT_THROW(Relocalizer(world.map, first_scan(world), options, 1), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::pf_relocalize
