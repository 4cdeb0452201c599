// SPDX-License-Identifier: BSD-3-Clause
//
// What a relocalisation costs: start on helices and one step with 8000 particles × 10 observations, likelihoods per
// second on one core, and the arithmetic of the inner loop alone. "pairs/s" counts particle × landmark likelihoods
// p(z|x, m) closer than 6 σ, which cannot be left out, per second of processor time of one core; "weighed/s" counts all
// that are computed, including neighbours of a tile that only some of its particles see.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "clones.hpp"
#include "helixnav/pf_relocalize/relocalizer.hpp"
#include "helixnav/pf_relocalize/rivals.hpp"
#include "lattice_world.hpp"
#include "scatter_world.hpp"
#include "tile_sum.hpp"

namespace {

using namespace helixnav;
using namespace helixnav::pf_relocalize;

constexpr std::size_t particles = 8000;
constexpr std::size_t observations = 10;

/// A scan of exactly ten observations.
core::Scan ten(test::ScatterWorld& world) {
  core::Scan scan = world.scan();
  while (scan.observations.size() < observations) scan = world.scan();
  scan.observations.erase(scan.observations.begin() + observations, scan.observations.end());
  return scan;
}

RelocalizerOptions options_for(unsigned threads) {
  RelocalizerOptions options;
  options.least_particles = options.most_particles = particles;
  options.threads = threads;
  return options;
}

void start_on_helices(benchmark::State& state) {
  test::ScatterWorld world({}, 1);
  const core::Scan scan = ten(world);
  for (auto _ : state) {
    const Relocalizer search(world.map, scan, options_for(static_cast<unsigned>(state.range(0))), 1);
    benchmark::DoNotOptimize(search.state().log_evidence);
  }
}
BENCHMARK(start_on_helices)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

void one_step(benchmark::State& state) {
  test::ScatterWorld world({}, 1);
  Relocalizer search(world.map, ten(world), options_for(static_cast<unsigned>(state.range(0))), 1);
  for (auto _ : state) {
    state.PauseTiming();
    const core::Odometry motion = world.drive();
    if (world.truth.position_m().norm() > 25.0) world.truth = core::Pose2(0.0, 0.0, 0.0);
    const core::Scan scan = ten(world);
    state.ResumeTiming();
    search.step(motion, scan);
  }
}
BENCHMARK(one_step)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

/// Pairs that matter: point and landmark closer than 6 σ.
double pairs_within_reach(const ReferenceMap& map, const core::Scan& scan, const Particles& cloud) {
  double pairs = 0.0;
  for (const RobotPoint& point : robot_points(scan)) {
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector2d seen = core::transform(cloud.pose(i), point.mean_m);
      for (const core::PointGaussian& m : map.landmarks) {
        const double variance = largest_variance(point.covariance_m2) + largest_variance(m.covariance_m2);
        pairs += (seen - m.mean_m).squaredNorm() < 36.0 * variance ? 1.0 : 0.0;
      }
    }
  }
  return pairs;
}

/// Pairs that are weighed: tile by tile, all those of a landmark within reach of one particle of the tile.
double pairs_weighed(const ReferenceMap& map, const core::Scan& scan, const Particles& cloud) {
  const LandmarkTable table(map);
  double pairs = 0.0;
  for (std::size_t first = 0; first < cloud.size(); first += tile_size) {
    ParticleTile tile(table, cloud, first, std::min(first + tile_size, cloud.size()));
    for (const RobotPoint& point : robot_points(scan)) {
      TileArray sum{};
      add_point_densities(
          tile, point,
          [&](std::uint32_t) {
            pairs += static_cast<double>(tile.poses.n);
            return sum.data();
          },
          sum.data());
    }
  }
  return pairs;
}

/// Particles all over the prior (spread 1) or about the truth (spread 0), in a map of the given spacing.
void likelihoods(benchmark::State& state) {
  test::ScatterOptions world_options;
  world_options.spacing_m = static_cast<double>(state.range(0));
  test::ScatterWorld world(world_options, 2);
  ScanLikelihood likelihood(world.map, {});
  const core::Scan scan = ten(world);
  likelihood.set_scan(scan);
  core::RandomStream random(3, "bench");
  Particles cloud;
  cloud.resize(particles);
  const Eigen::Matrix3d spread = (state.range(1) == 1 ? 1.0 : 1e-3) * world.map.prior.covariance;
  for (std::size_t i = 0; i < particles; ++i)
    cloud.set_pose(i, core::Pose2(world.truth.vector() + random.normal3(spread)));
  order_by_place(cloud);
  std::vector<double> out(particles);
  for (auto _ : state) {
    likelihood.evaluate(cloud, 0, particles, out.data());
    benchmark::DoNotOptimize(out.data());
  }
  const double pairs = pairs_within_reach(world.map, scan, cloud);
  state.counters["pairs/particle"] = pairs / static_cast<double>(particles);
  state.counters["pairs/s"] = benchmark::Counter(pairs, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["weighed/s"] =
      benchmark::Counter(pairs_weighed(world.map, scan, cloud), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(likelihoods)
    ->ArgNames({"spacing", "spread"})
    ->ArgsProduct({{8, 4, 2}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

/// The loop over a tile alone: the limit of the above if neighbours cost nothing to find. 48 flops per pair, the division
/// and the square root counted as one each.
void tile_arithmetic(benchmark::State& state) {
  PlacedPoints placed;
  TileArray factor, sum{};
  core::RandomStream random(4, "bench");
  for (std::size_t p = 0; p < tile_size; ++p) {
    placed.x[p] = random.normal();
    placed.y[p] = random.normal();
    placed.sxx[p] = 0.3;
    placed.sxy[p] = 0.05;
    placed.syy[p] = 0.2;
    factor[p] = 1.0;
  }
  const TileLandmark landmark{0.0, 0.0, 0.1, 0.0, 0.1};
  for (auto _ : state) {
    add_densities(tile_size, placed, landmark, factor.data(), sum.data());
    benchmark::DoNotOptimize(sum.data());
  }
  state.counters["pairs/s"] = benchmark::Counter(tile_size, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["flop/s"] = benchmark::Counter(48.0 * tile_size, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(tile_arithmetic);

/// Fused multiply-adds on registers, written as the compiler vectorises them: what one core can do, for comparison.
HELIXNAV_CLONES double multiply_add(std::size_t rounds) {
  alignas(64) double lanes[64];
  for (int i = 0; i < 64; ++i) lanes[i] = 1.0 + i;
  for (std::size_t r = 0; r < rounds; ++r) {
    for (int i = 0; i < 64; ++i) lanes[i] = lanes[i] * 0.999999 + 1e-6;
  }
  double sum = 0.0;
  for (const double lane : lanes) sum += lane;
  return sum;
}

void machine_limit(benchmark::State& state) {
  constexpr std::size_t rounds = 10000;
  for (auto _ : state) benchmark::DoNotOptimize(multiply_add(rounds));
  state.counters["flop/s"] = benchmark::Counter(2.0 * 64.0 * rounds, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(machine_limit);

void reference_map_rivals(benchmark::State& state) {
  test::Lattice lattice;
  const ReferenceMap map = lattice.map(6.0, 3.0, 0.1);
  const Constellation constellation = lattice.constellation();
  for (auto _ : state) {
    const RivalPoses poses = find_rivals(map, constellation.branch, lattice.truth(), {}, 1);
    benchmark::DoNotOptimize(judge_constellation(constellation, poses.winner, poses.rivals).accepted);
  }
}
BENCHMARK(reference_map_rivals)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
