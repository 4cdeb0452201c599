// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "index/parts.hpp"

namespace helixnav::relocalize {

namespace {

Sides sides_of(const Nodes& nodes, Code code) {
  const Corners at = corners_of(nodes, code);
  const auto side = [&](std::size_t a, std::size_t b) {
    return std::sqrt(squared_distance_m2(nodes[at[a]], nodes[at[b]]));
  };
  return {side(0, 1), side(1, 2), side(2, 0)};
}

/// The longest side that only one triangle in twenty exceeds, by a sample of some thousands.
float usual_longest_m(const Nodes& nodes, const std::vector<Code>& codes, float otherwise_m) {
  if (codes.size() < 100) return otherwise_m;
  std::vector<float> sample;
  for (std::size_t i = 0; i < codes.size(); i += 1 + codes.size() / 4000)
    sample.push_back(sides_of(nodes, codes[i])[0]);
  const auto at = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() * 19 / 20);
  std::nth_element(sample.begin(), at, sample.end());
  return *at;
}

TriangleBins bins_for(const MapIndex::Parts& parts, const std::vector<Code>& codes, std::size_t expected) {
  TriangleBins bins(expected, usual_longest_m(parts.nodes, codes, parts.reach_m), parts.side_tolerance_m() / 3.0F);
  for (const Code code : codes) bins.insert(sides_of(parts.nodes, code), code);
  return bins;
}

}  // namespace

void MapIndex::Parts::store_all_triangles() {
  for (Slot slot = 0; slot < nodes.size(); ++slot) {
    std::size_t place = 0;
    for (const Neighbour& neighbour : nearest(slot, neighbours)) nodes[slot].near[place++] = neighbour.slot;
    measure_farthest(slot);
  }
  std::vector<Code> codes;
  for (Slot slot = 0; slot < nodes.size(); ++slot) {
    const auto& near = nodes[slot].near;
    for (std::size_t i = 0; i < near.size() && near[i] != no_slot; ++i)
      for (std::size_t j = i + 1; j < near.size() && near[j] != no_slot; ++j) {
        const auto triangle = stored(nodes, {slot, near[i], near[j]}, least_side_m());
        if (!triangle || owner_of(triangle->code) != slot) continue;
        codes.push_back(triangle->code);
        rarity.count(triangle->sides_m, 1);
      }
  }
  bins = bins_for(*this, codes, codes.size());
}

/// Bins for a map that has outgrown its own, with room to grow almost twofold.
void MapIndex::Parts::refit() {
  std::vector<Code> codes;
  bins.all([&](const Code* some, std::uint32_t number) { codes.insert(codes.end(), some, some + number); });
  bins = bins_for(*this, codes, codes.size() * 5 / 4);
}

}  // namespace helixnav::relocalize
