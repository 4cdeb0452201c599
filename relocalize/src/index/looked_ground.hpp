// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "index/cell_table.hpp"

namespace helixnav::relocalize {

/// The ground a sensor looked at, as square cells in blocks of 8×8. Coordinates from the index's origin.
class LookedGround {
 public:
  explicit LookedGround(double cell_m) : cell_m_(cell_m) {}

  /// Marks the cells whose centres lie within the disc.
  void mark(double x_m, double y_m, double radius_m);

  bool covers(double x_m, double y_m) const;
  double area_m2() const { return static_cast<double>(marked_) * cell_m_ * cell_m_; }
  std::size_t memory_bytes() const { return table_.memory_bytes() + blocks_.capacity() * sizeof(std::uint64_t); }

 private:
  double cell_m_;
  std::size_t marked_ = 0;
  CellTable table_;
  std::vector<std::uint64_t> blocks_;
};

}  // namespace helixnav::relocalize
