// SPDX-License-Identifier: BSD-3-Clause
//
// What the index of a map and a question cost, in maps of 10⁴, 10⁵ and 10⁶ landmarks spread evenly, one in 64 m².
// "bytes" is memory per landmark.
#include <benchmark/benchmark.h>

#include <map>
#include <memory>

#include "worlds.hpp"

namespace {

using namespace helixnav;
using namespace helixnav::relocalize;

constexpr IndexOptions options = {30.0, 0.1};

const test::Points& world_of(std::size_t count) {
  static std::map<std::size_t, test::Points> worlds;
  auto& world = worlds[count];
  core::RandomStream random(1);
  if (world.empty()) world = test::uniform_world(count, random);
  return world;
}

MapIndex& index_of(std::size_t count) {
  static std::map<std::size_t, std::unique_ptr<MapIndex>> indices;
  auto& index = indices[count];
  if (!index) index = std::make_unique<MapIndex>(test::index_of(world_of(count), options));
  return *index;
}

void build(benchmark::State& state) {
  const auto landmarks = test::landmarks(world_of(static_cast<std::size_t>(state.range(0))), options.pair_noise_m);
  for (auto _ : state) {
    const MapIndex index(options, landmarks);
    state.counters["bytes"] = static_cast<double>(index.memory_bytes()) / static_cast<double>(index.size());
  }
}
BENCHMARK(build)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);

/// Landmark by landmark from nothing, in the order of a drive up and down the map; time per landmark.
void grow(benchmark::State& state) {
  auto landmarks = test::landmarks(world_of(static_cast<std::size_t>(state.range(0))), options.pair_noise_m);
  std::sort(landmarks.begin(), landmarks.end(), [](const Landmark& a, const Landmark& b) {
    const auto lane = [](const Landmark& l) { return std::floor(l.point.mean_m.x() / 40.0); };
    return lane(a) != lane(b) ? lane(a) < lane(b) : a.point.mean_m.y() < b.point.mean_m.y();
  });
  for (auto _ : state) {
    MapIndex index(options);
    for (const Landmark& landmark : landmarks) index.insert(landmark);
    state.counters["bytes"] = static_cast<double>(index.memory_bytes()) / static_cast<double>(index.size());
  }
  state.counters["us_each"] =
      benchmark::Counter(static_cast<double>(landmarks.size()) * 1e-6,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(grow)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);

void move(benchmark::State& state) {
  MapIndex& index = index_of(static_cast<std::size_t>(state.range(0)));
  const auto landmarks = test::landmarks(world_of(index.size()), options.pair_noise_m);
  core::RandomStream random(2);
  for (auto _ : state) index.move(landmarks[random.below(landmarks.size())]);
}
BENCHMARK(move)->Arg(10000)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMicrosecond);

void question(benchmark::State& state) {
  const MapIndex& index = index_of(static_cast<std::size_t>(state.range(0)));
  std::vector<Question> questions;
  core::RandomStream random(3);
  for (int q = 0; q < 20; ++q) {
    test::Asking asking;
    asking.change = 0.3;
    questions.push_back(test::ask_somewhere(world_of(index.size()), asking, random).question);
  }
  std::size_t at = 0;
  for (auto _ : state) benchmark::DoNotOptimize(ask(index, questions[at++ % questions.size()]).gap);
}
BENCHMARK(question)->Arg(10000)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
