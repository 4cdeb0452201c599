// SPDX-License-Identifier: BSD-3-Clause
#include "index/looked_ground.hpp"

#include <cmath>

namespace helixnav::relocalize {

namespace {

std::int32_t cell_of(double value) { return static_cast<std::int32_t>(std::floor(value)); }

std::uint64_t bit_of(std::int32_t column, std::int32_t row) {
  return std::uint64_t{1} << static_cast<unsigned>((row & 7) * 8 + (column & 7));
}

}  // namespace

void LookedGround::mark(double x_m, double y_m, double radius_m) {
  for (std::int32_t row = cell_of((y_m - radius_m) / cell_m_); row <= cell_of((y_m + radius_m) / cell_m_); ++row) {
    const double dy = (row + 0.5) * cell_m_ - y_m;
    const double left_m2 = radius_m * radius_m - dy * dy;
    if (left_m2 < 0.0) continue;
    const double half_m = std::sqrt(left_m2);
    const std::int32_t last = cell_of((x_m + half_m) / cell_m_ - 0.5);
    for (auto column = static_cast<std::int32_t>(std::ceil((x_m - half_m) / cell_m_ - 0.5)); column <= last; ++column) {
      const std::uint32_t block = table_.number(column >> 3, row >> 3);
      if (block == blocks_.size()) blocks_.push_back(0);
      marked_ += (blocks_[block] & bit_of(column, row)) == 0 ? 1 : 0;
      blocks_[block] |= bit_of(column, row);
    }
  }
}

bool LookedGround::covers(double x_m, double y_m) const {
  const std::int32_t column = cell_of(x_m / cell_m_);
  const std::int32_t row = cell_of(y_m / cell_m_);
  const std::uint32_t block = table_.find(column >> 3, row >> 3);
  return block != CellTable::none && (blocks_[block] & bit_of(column, row)) != 0;
}

}  // namespace helixnav::relocalize
