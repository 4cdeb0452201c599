// SPDX-License-Identifier: BSD-3-Clause
#include "persistent_map.hpp"

#include <cmath>
#include <map>
#include <unordered_set>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"
#include "helixnav/core/worker_pool.hpp"

namespace helixnav::fastslam {
namespace {

using Twin = std::map<LineageId, float>;

void write(PersistentMap& map, LineageId id, float value, NodePool& pool) {
  map.write(id, pool) = {value, -value, 1.0F, 0.0F, 2.0F, value, 0, 0, 1, 0};
}

/// Both hold the same landmarks with the same contents, both by lookup and in order.
void expect_equal(const PersistentMap& map, const Twin& twin, LineageId ids) {
  EXPECT_EQ(map.size(), twin.size());
  auto next = twin.begin();
  map.for_each([&](LineageId id, const LandmarkRecord& landmark) {
    ASSERT_NE(next, twin.end());
    EXPECT_EQ(id, next->first);
    EXPECT_EQ(landmark.dx_m, next->second);
    EXPECT_EQ(landmark.dy_m, -next->second);
    ++next;
  });
  EXPECT_EQ(next, twin.end());
  for (LineageId id = 0; id < ids; ++id) ASSERT_EQ(map.find(id) != nullptr, twin.count(id) == 1) << id;
}

/// Bytes of the reachable nodes, each counted once.
std::ptrdiff_t reachable_bytes(const std::vector<PersistentMap>& maps) {
  std::unordered_set<const void*> seen;
  std::size_t leaves = 0;
  for (const PersistentMap& map : maps) {
    map.for_each_leaf([&](const void* at) { return !seen.insert(at).second; },
                      [&](LineageId, const MapLeaf&) { ++leaves; });
  }
  return static_cast<std::ptrdiff_t>(leaves * sizeof(MapLeaf) + (seen.size() - leaves) * sizeof(MapNode));
}

TEST(PersistentMap, EqualsAStdMapAParticleOverRandomPrograms) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    core::RandomStream random(seed, "persistent map");
    NodePool pool(true);
    const LineageId ids = seed % 2 == 0 ? 40 : 3000;
    std::vector<PersistentMap> maps(12);
    std::vector<Twin> twins(12);
    for (int step = 0; step < 3000; ++step) {
      const std::size_t at = random.below(maps.size());
      const auto id = static_cast<LineageId>(random.below(1 + random.below(ids)));
      const double what = random.uniform();
      if (what < 0.7) {
        write(maps[at], id, static_cast<float>(step), pool);
        twins[at][id] = static_cast<float>(step);
      } else if (what < 0.8) {
        maps[at].erase(id, pool);
        twins[at].erase(id);
      } else if (what < 0.99) {
        const std::size_t from = random.below(maps.size());
        maps[at].share(maps[from], pool);
        twins[at] = Twin(twins[from]);
      } else {
        maps[at].clear(pool);
        twins[at].clear();
      }
    }
    for (std::size_t i = 0; i < maps.size(); ++i) expect_equal(maps[i], twins[i], ids);
    EXPECT_EQ(pool.live_bytes(), reachable_bytes(maps));
    for (PersistentMap& map : maps) map.clear(pool);
    EXPECT_EQ(pool.live_bytes(), 0);
  }
}

TEST(PersistentMap, AWriteInOneCopyDoesNotShowInAnother) {
  NodePool pool(true);
  std::vector<PersistentMap> maps(3);
  for (LineageId id = 0; id < 500; ++id) write(maps[0], id, 1.0F, pool);
  maps[1].share(maps[0], pool);
  maps[2].share(maps[1], pool);
  write(maps[1], 77, 2.0F, pool);
  maps[2].erase(78, pool);
  EXPECT_EQ(maps[0].find(77)->dx_m, 1.0F);
  EXPECT_EQ(maps[1].find(77)->dx_m, 2.0F);
  EXPECT_EQ(maps[2].find(77)->dx_m, 1.0F);
  EXPECT_NE(maps[0].find(78), nullptr);
  EXPECT_EQ(maps[2].find(78), nullptr);
  for (PersistentMap& map : maps) map.clear(pool);
}

TEST(PersistentMap, AWriteNobodySharesTakesNoMemory) {
  NodePool pool(true);
  PersistentMap map;
  for (LineageId id = 0; id < 1000; ++id) write(map, id, 0.0F, pool);
  const std::ptrdiff_t before = pool.live_bytes();
  const LandmarkRecord* place = map.find(500);
  write(map, 500, 3.0F, pool);
  EXPECT_EQ(map.find(500), place);
  EXPECT_EQ(pool.live_bytes(), before);
  map.clear(pool);
}

TEST(PersistentMap, ACopyAndItsFirstWriteCostOneLeafAndOnePathWhateverTheSize) {
  for (const LineageId n : {100U, 2000U, 30'000U}) {
    NodePool pool(true);
    std::vector<PersistentMap> maps(2);
    for (LineageId id = 0; id < n; ++id) write(maps[0], id, 0.0F, pool);
    const std::ptrdiff_t before = pool.live_bytes();
    maps[1].share(maps[0], pool);
    EXPECT_EQ(pool.live_bytes(), before);
    write(maps[1], n / 2, 1.0F, pool);
    const std::ptrdiff_t levels = n <= 128 ? 1 : n <= 2048 ? 2 : 3;
    EXPECT_EQ(pool.live_bytes() - before,
              static_cast<std::ptrdiff_t>(sizeof(MapLeaf)) + levels * static_cast<std::ptrdiff_t>(sizeof(MapNode)));
    for (PersistentMap& map : maps) map.clear(pool);
  }
}

TEST(PersistentMap, ThreadsMayWriteMapsThatShareNodes) {
  constexpr std::size_t slices = 4, each = 8;
  std::vector<NodePool> pools;
  for (std::size_t s = 0; s < slices; ++s) pools.emplace_back(false);
  std::vector<PersistentMap> maps(slices * each);
  for (LineageId id = 0; id < 400; ++id) write(maps[0], id, 0.0F, pools[0]);
  core::WorkerPool workers(slices);
  for (int round = 0; round < 10; ++round) {
    for (std::size_t i = 1; i < maps.size(); ++i) maps[i].share(maps[0], pools[0]);
    workers.for_each(slices, [&](std::size_t s) {
      for (std::size_t i = s * each; i < (s + 1) * each; ++i) {
        for (LineageId id = 0; id < 400; id += 7) write(maps[i], id, static_cast<float>(i + 100 * round), pools[s]);
      }
    });
    for (std::size_t i = 0; i < maps.size(); ++i) {
      for (LineageId id = 0; id < 400; id += 7) ASSERT_EQ(maps[i].find(id)->dx_m, static_cast<float>(i + 100 * round));
    }
  }
  std::ptrdiff_t live = 0;
  for (const NodePool& pool : pools) live += pool.live_bytes();
  EXPECT_EQ(live, reachable_bytes(maps));
  for (PersistentMap& map : maps) map.clear(pools[0]);
}

TEST(LandmarkRecord, KeepsNeedleShapedCovariancesPositiveDefinite) {
  core::RandomStream random(3, "record");
  std::vector<LandmarkRecord> records(2000);
  std::vector<double> traces;
  for (LandmarkRecord& record : records) {
    const double angle = random.uniform(-3.0, 3.0), longest = std::exp(random.uniform(-8.0, 4.0));
    const double shortest = longest * std::pow(10.0, random.uniform(-9.0, 0.0));
    const double c = std::cos(angle), s = std::sin(angle);
    record.set_covariance_m2(
        {c * c * longest + s * s * shortest, c * s * (longest - shortest), s * s * longest + c * c * shortest});
    traces.push_back(longest + shortest);
  }
  for (std::size_t k = 0; k < records.size(); ++k) {
    const Symmetric2 P = records[k].covariance_m2();
    EXPECT_GT(P.xx, 0.0);
    EXPECT_GT(P.xx * P.yy - P.xy * P.xy, 0.0);
    EXPECT_NEAR(P.trace(), traces[k], 1e-6 * traces[k]);
  }
}

}  // namespace
}  // namespace helixnav::fastslam
