// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "helixnav/sim/world.hpp"

namespace helixnav::sim {

/// The trees of a world by square cells of the plane, for a scanner that would otherwise check every tree of a town in
/// each scan. Test: sim/tree_grid_test.cpp (brute force).
class TreeGrid {
 public:
  /// `cell_m`: roughly the query distance.
  TreeGrid(const std::vector<Tree>& trees, double cell_m);

  /// Indices of all trees within `radius_m` of `point_m`, and of others nearby, in no particular order. O(trees
  /// nearby).
  std::vector<std::size_t> about(const Eigen::Vector2d& point_m, double radius_m) const;

 private:
  using Cell = std::pair<int, int>;

  Cell cell_of(const Eigen::Vector2d& point_m) const;

  double cell_m_;
  std::vector<std::pair<Cell, std::size_t>> by_cell_;  ///< sorted
};

}  // namespace helixnav::sim
