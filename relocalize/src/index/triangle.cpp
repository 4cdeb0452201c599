// SPDX-License-Identifier: BSD-3-Clause
#include "index/triangle.hpp"

#include <algorithm>

namespace helixnav::relocalize {

namespace {

constexpr int turns = 6;
constexpr int pairs = neighbours * (neighbours - 1) / 2;

constexpr int pair_number(int i, int j) { return i * (2 * neighbours - 1 - i) / 2 + j - i - 1; }

/// Turns 0–2 keep the orientation of (owner, i, j), 3–5 reverse it; the start advances.
constexpr std::array<int, 3> order_of(int turn) {
  const std::array<int, 3> base = turn < 3 ? std::array<int, 3>{0, 1, 2} : std::array<int, 3>{0, 2, 1};
  const auto start = static_cast<std::size_t>(turn % 3);
  return {base[start], base[(start + 1) % 3], base[(start + 2) % 3]};
}

constexpr std::array<Decoded, 256> make_table() {
  std::array<Decoded, 256> table{};
  for (int i = 0; i < neighbours; ++i)
    for (int j = i + 1; j < neighbours; ++j)
      for (int turn = 0; turn < turns; ++turn) {
        const auto order = order_of(turn);
        Decoded& entry = table[static_cast<std::size_t>(pair_number(i, j) * turns + turn)];
        entry.i = static_cast<std::uint8_t>(i);
        entry.j = static_cast<std::uint8_t>(j);
        for (std::size_t k = 0; k < 3; ++k) entry.order[k] = static_cast<std::uint8_t>(order[k]);
      }
  return table;
}

}  // namespace

static_assert(pairs * turns <= 256, "a byte tells the pair and its turn");

Code encode(Slot owner, int i, int j, const std::array<int, 3>& order) {
  int turn = 0;
  while (order_of(turn) != order) ++turn;
  return owner << 8U | static_cast<Code>(pair_number(i, j) * turns + turn);
}

constexpr std::array<Decoded, 256> table = make_table();
const std::array<Decoded, 256> decoded = table;

std::optional<Stored> stored(const Nodes& nodes, std::array<Slot, 3> corners, float least_m) {
  std::sort(corners.begin(), corners.end());
  for (std::size_t k = 0; k < 3; ++k) {
    const Slot owner = corners[k];
    int i = place_among(nodes, owner, corners[(k + 1) % 3]);
    int j = place_among(nodes, owner, corners[(k + 2) % 3]);
    if (i < 0 || j < 0) continue;
    if (i > j) std::swap(i, j);
    const auto& near = nodes[owner].near;
    const auto shape = canonical(nodes[owner], nodes[near[static_cast<std::size_t>(i)]],
                                 nodes[near[static_cast<std::size_t>(j)]], least_m);
    if (!shape) return std::nullopt;
    return Stored{encode(owner, i, j, shape->order), shape->sides_m};
  }
  return std::nullopt;
}

}  // namespace helixnav::relocalize
