// SPDX-License-Identifier: BSD-3-Clause
//
// Cost of the compressed EKF's operations, by retraction (0 standard, 1 right-invariant), map size and active set.
#include <benchmark/benchmark.h>

#include "cekf_world.hpp"

namespace {

using namespace helixnav;

cekf::Retraction retraction(const benchmark::State& state) {
  return state.range(0) == 0 ? cekf::Retraction::standard : cekf::Retraction::right_invariant;
}

bench::CekfWorld world_for(const benchmark::State& state) {
  return bench::CekfWorld(retraction(state), static_cast<int>(state.range(1)), static_cast<int>(state.range(2)));
}

void predict_and_update_8(benchmark::State& state) {
  bench::CekfWorld world = world_for(state);
  for (auto _ : state) {
    state.PauseTiming();
    const std::vector<cekf::Match>& matches = world.look();
    state.ResumeTiming();
    world.filter.predict(world.odometry());
    world.filter.update(matches);
  }
}
BENCHMARK(predict_and_update_8)->ArgsProduct({{0, 1}, {100, 1000, 5000}, {40}})->Args({1, 1000, 80});

void snapshot(benchmark::State& state) {
  const bench::CekfWorld world = world_for(state);
  for (auto _ : state) benchmark::DoNotOptimize(world.filter.snapshot());
  state.counters["kB"] = static_cast<double>(world.filter.snapshot().bytes()) * 1e-3;
}
BENCHMARK(snapshot)->ArgsProduct({{0, 1}, {1000}, {40, 50}});

void activate_one(benchmark::State& state) {
  bench::CekfWorld world = world_for(state);
  core::LandmarkId passive = 0;
  while (world.filter.is_active(passive)) ++passive;
  const cekf::Snapshot before = world.filter.snapshot();
  for (auto _ : state) {
    world.filter.activate(passive);
    state.PauseTiming();
    world.filter.restore(before);
    state.ResumeTiming();
  }
}
BENCHMARK(activate_one)->ArgsProduct({{0, 1}, {1000, 5000}, {40}});

void passive_marginal(benchmark::State& state) {
  const bench::CekfWorld world = world_for(state);
  core::LandmarkId passive = 0;
  while (world.filter.is_active(passive)) ++passive;
  for (auto _ : state) benchmark::DoNotOptimize(world.filter.landmark(passive));
}
BENCHMARK(passive_marginal)->ArgsProduct({{0, 1}, {1000}, {40}});

void landmarks_within_30_m(benchmark::State& state) {
  const bench::CekfWorld world = world_for(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(world.filter.landmarks_within(world.filter.pose().mean.position_m(), 30.0));
  }
}
BENCHMARK(landmarks_within_30_m)->ArgsProduct({{1}, {1000, 5000}, {40}});

void global_update(benchmark::State& state) {
  bench::CekfWorld world = world_for(state);
  for (auto _ : state) {
    state.PauseTiming();
    world.filter.predict(world.odometry());
    world.filter.update(world.look());
    state.ResumeTiming();
    world.filter.global_update();
  }
}
BENCHMARK(global_update)->ArgsProduct({{0, 1}, {1000, 2000}, {40}})->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
