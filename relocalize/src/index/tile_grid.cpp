// SPDX-License-Identifier: BSD-3-Clause
#include "index/tile_grid.hpp"

namespace helixnav::relocalize {

TileGrid::Tile& TileGrid::tile_at(std::int32_t column, std::int32_t row) {
  const std::uint32_t number = table_.number(column, row);
  if (number == tiles_.size()) tiles_.push_back(Tile());
  return tiles_[number];
}

Slot& TileGrid::head_of(const Node& node) {
  const float scale = cells / side_m_;
  const std::int32_t column = floor_of(node.x_m * scale);
  const std::int32_t row = floor_of(node.y_m * scale);
  Tile& tile = tile_at(column >> cell_bits, row >> cell_bits);
  return tile.head[static_cast<std::size_t>((row & (cells - 1)) * cells + (column & (cells - 1)))];
}

TileGrid::Box TileGrid::bits_near(const Node& node) const {
  const float scale = bits / side_m_;
  return {floor_of((node.x_m - near_m_) * scale), floor_of((node.x_m + near_m_) * scale),
          floor_of((node.y_m - near_m_) * scale), floor_of((node.y_m + near_m_) * scale)};
}

void TileGrid::write_bits(const Box& box, bool value) {
  for (std::int32_t row = box.first_row; row <= box.last_row; ++row)
    for (std::int32_t column = box.first_column; column <= box.last_column; ++column) {
      std::uint64_t& word =
          tile_at(column >> bit_bits, row >> bit_bits).bit[static_cast<std::size_t>(row & (bits - 1))];
      const std::uint64_t mask = std::uint64_t{1} << (column & (bits - 1));
      word = value ? word | mask : word & ~mask;
    }
}

void TileGrid::insert(Nodes& nodes, Slot slot) {
  Slot& head = head_of(nodes[slot]);
  nodes[slot].next = head;
  head = slot;
  write_bits(bits_near(nodes[slot]), true);
  ++landmarks_;
}

void TileGrid::erase(Nodes& nodes, Slot slot) {
  Slot* link = &head_of(nodes[slot]);
  while (*link != slot) link = &nodes[*link].next;
  *link = nodes[slot].next;
  --landmarks_;
  // Bits are shared: clear them, then set again those of every landmark near enough to have set one.
  write_bits(bits_near(nodes[slot]), false);
  const float far_m = 1.5F * (2.0F * near_m_ + 2.0F * side_m_ / bits);
  within(nodes, nodes[slot].x_m, nodes[slot].y_m, far_m,
         [&](Slot other, float) { write_bits(bits_near(nodes[other]), true); });
}

}  // namespace helixnav::relocalize
