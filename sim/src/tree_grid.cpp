// SPDX-License-Identifier: BSD-3-Clause
#include "tree_grid.hpp"

#include <algorithm>
#include <cmath>

namespace helixnav::sim {

TreeGrid::TreeGrid(const std::vector<Tree>& trees, double cell_m) : cell_m_(cell_m) {
  by_cell_.reserve(trees.size());
  for (std::size_t i = 0; i < trees.size(); ++i) by_cell_.emplace_back(cell_of(trees[i].point_m), i);
  std::sort(by_cell_.begin(), by_cell_.end());
}

std::vector<std::size_t> TreeGrid::about(const Eigen::Vector2d& point_m, double radius_m) const {
  const Cell low = cell_of(point_m - Eigen::Vector2d::Constant(radius_m));
  const Cell high = cell_of(point_m + Eigen::Vector2d::Constant(radius_m));
  std::vector<std::size_t> found;
  for (int column = low.first; column <= high.first; ++column) {
    const std::pair<Cell, std::size_t> first(Cell(column, low.second), 0);
    for (auto tree = std::lower_bound(by_cell_.begin(), by_cell_.end(), first);
         tree != by_cell_.end() && tree->first <= Cell(column, high.second); ++tree) {
      found.push_back(tree->second);
    }
  }
  return found;
}

TreeGrid::Cell TreeGrid::cell_of(const Eigen::Vector2d& point_m) const {
  return {static_cast<int>(std::floor(point_m.x() / cell_m_)), static_cast<int>(std::floor(point_m.y() / cell_m_))};
}

}  // namespace helixnav::sim
