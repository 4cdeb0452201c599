// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "index/cell_table.hpp"
#include "index/node.hpp"

namespace helixnav::relocalize {

/// Where landmarks stand: tiles that exist only where there are any, each with 8×8 lists of landmarks and 64×64 bits that
/// tell in one look that no landmark is near. Tiles shrink as landmarks become dense; what is asked depends on neither.
class TileGrid {
 public:
  /// A bit is set when a landmark may stand within `near_m` of some point of its square.
  TileGrid(float tile_side_m, float near_m) : side_m_(tile_side_m), near_m_(near_m) {}

  void insert(Nodes& nodes, Slot slot);
  void erase(Nodes& nodes, Slot slot);

  /// More landmarks a tile than is quick: time for smaller tiles, unless these came near `near_m`.
  bool crowded() const { return landmarks_ > 64 * (tiles_.size() + 1) && side_m_ > 12.0F * near_m_; }
  TileGrid finer() const { return TileGrid(0.7F * side_m_, near_m_); }

  float cell_m() const { return side_m_ / cells; }
  std::size_t memory_bytes() const { return table_.memory_bytes() + tiles_.memory_bytes(); }

  /// Calls visit(slot, squared distance) for all landmarks within radius_m.
  template <class Visit>
  void within(const Nodes& nodes, float x_m, float y_m, float radius_m, Visit&& visit) const {
    any_within(nodes, x_m, y_m, radius_m, [&](Slot slot, float squared_m2) {
      visit(slot, squared_m2);
      return false;
    });
  }

  /// The same until one of them is the one.
  template <class Is>
  bool any_within(const Nodes& nodes, float x_m, float y_m, float radius_m, Is&& is) const {
    const float scale = cells / side_m_;
    const std::int32_t first_column = floor_of((x_m - radius_m) * scale);
    const std::int32_t last_column = floor_of((x_m + radius_m) * scale);
    const std::int32_t last_row = floor_of((y_m + radius_m) * scale);
    const float most_m2 = radius_m * radius_m;
    for (std::int32_t row = floor_of((y_m - radius_m) * scale); row <= last_row;) {
      const std::int32_t rows_end = std::min(last_row, row | (cells - 1));
      for (std::int32_t column = first_column; column <= last_column;) {
        const std::int32_t columns_end = std::min(last_column, column | (cells - 1));
        const std::uint32_t tile = table_.find(column >> cell_bits, row >> cell_bits);
        if (tile != CellTable::none &&
            any_in_cells(nodes, tiles_[tile], {column, columns_end, row, rows_end}, x_m, y_m, most_m2, is)) {
          return true;
        }
        column = columns_end + 1;
      }
      row = rows_end + 1;
    }
    return false;
  }

  /// Where the bit of a point is; null if there is no tile.
  struct Probe {
    const std::uint64_t* word = nullptr;
    std::uint64_t mask = 0;
    bool set() const { return word != nullptr && (*word & mask) != 0; }
  };
  Probe probe(float x_m, float y_m) const {
    const float scale = bits / side_m_;
    const std::int32_t column = floor_of(x_m * scale);
    const std::int32_t row = floor_of(y_m * scale);
    const std::uint32_t tile = table_.find(column >> bit_bits, row >> bit_bits);
    if (tile == CellTable::none) return {};
    return {&tiles_[tile].bit[static_cast<std::size_t>(row & (bits - 1))], std::uint64_t{1} << (column & (bits - 1))};
  }

  /// Is a landmark within radius_m ≤ near_m?
  bool occupied(const Nodes& nodes, float x_m, float y_m, float radius_m) const {
    return probe(x_m, y_m).set() && holds(nodes, x_m, y_m, radius_m);
  }

  /// The same without checking the bit.
  bool holds(const Nodes& nodes, float x_m, float y_m, float radius_m) const {
    return any_within(nodes, x_m, y_m, radius_m, [](Slot, float) { return true; });
  }

 private:
  static constexpr std::int32_t cell_bits = 3;
  static constexpr std::int32_t cells = 1 << cell_bits;
  static constexpr std::int32_t bit_bits = 6;
  static constexpr std::int32_t bits = 1 << bit_bits;

  struct Tile {
    Tile() { head.fill(no_slot); }
    std::array<Slot, cells * cells> head;
    std::array<std::uint64_t, bits> bit{};
  };
  struct Box {
    std::int32_t first_column, last_column, first_row, last_row;
  };

  static std::int32_t floor_of(float value) {
    const auto whole = static_cast<std::int32_t>(value);
    return whole - static_cast<std::int32_t>(value < static_cast<float>(whole));
  }
  template <class Is>
  static bool any_in_cells(const Nodes& nodes, const Tile& tile, const Box& box, float x_m, float y_m, float most_m2,
                           Is& is) {
    for (std::int32_t row = box.first_row; row <= box.last_row; ++row)
      for (std::int32_t column = box.first_column; column <= box.last_column; ++column) {
        Slot slot = tile.head[static_cast<std::size_t>((row & (cells - 1)) * cells + (column & (cells - 1)))];
        for (; slot != no_slot; slot = nodes[slot].next) {
          const float dx = nodes[slot].x_m - x_m;
          const float dy = nodes[slot].y_m - y_m;
          const float d2 = dx * dx + dy * dy;
          if (d2 <= most_m2 && is(slot, d2)) return true;
        }
      }
    return false;
  }
  Tile& tile_at(std::int32_t column, std::int32_t row);
  Slot& head_of(const Node& node);
  Box bits_near(const Node& node) const;
  void write_bits(const Box& box, bool value);

  float side_m_;
  float near_m_;
  std::size_t landmarks_ = 0;
  CellTable table_;
  Paged<Tile, 3> tiles_;
};

}  // namespace helixnav::relocalize
