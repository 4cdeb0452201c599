// SPDX-License-Identifier: BSD-3-Clause
// Where the normal equations have entries, decided once before the first iteration.
#include <algorithm>
#include <utility>
#include <vector>

#include "normal_equations.hpp"

namespace helixnav::smoothing {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Off-diagonal blocks as (first column of the later variable, first column of the earlier one), ascending.
std::vector<std::pair<int, int>> blocks_of(const core::LandmarkGraph& graph, const Layout& layout) {
  std::vector<std::pair<int, int>> blocks;
  const auto add_block = [&blocks](int a, int b) {
    if (a >= 0 && b >= 0) blocks.emplace_back(std::max(a, b), std::min(a, b));
  };
  for (const auto& edge : graph.pose_edges) {
    add_block(layout.pose_column[at(edge.from)], layout.pose_column[at(edge.to)]);
  }
  for (const auto& edge : graph.landmark_edges) {
    add_block(layout.pose_column[at(edge.pose)], layout.landmark_column[at(edge.landmark)]);
  }
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  return blocks;
}

}  // namespace

void NormalEquations::analyse() {
  const core::LandmarkGraph& graph = problem_.graph;
  const std::vector<std::pair<int, int>> blocks = blocks_of(graph, layout_);
  const int first_landmark = layout_.landmark_column.empty() ? layout_.columns : layout_.landmark_column.front();
  const auto width = [first_landmark](int column) { return column < first_landmark ? 3 : 2; };
  column_start.push_back(0);
  auto block = blocks.cbegin();
  for (int variable = 0; variable < layout_.columns; variable += width(variable)) {
    const auto begin = block;
    while (block != blocks.cend() && block->first == variable) ++block;
    for (int c = 0; c < width(variable); ++c) {
      for (auto it = begin; it != block; ++it) {
        for (int r = 0; r < width(it->second); ++r) row_index.push_back(it->second + r);
      }
      diagonal_offset_.push_back(static_cast<int>(row_index.size()) - column_start.back());
      for (int r = 0; r <= c; ++r) row_index.push_back(variable + r);
      column_start.push_back(static_cast<int>(row_index.size()));
    }
  }
  values.assign(row_index.size(), 0.0);
  gradient = Eigen::VectorXd::Zero(layout_.columns);
  for (const auto& edge : graph.pose_edges) {
    odometry_slot_.push_back(slot(layout_.pose_column[at(edge.from)], layout_.pose_column[at(edge.to)]));
  }
  for (const auto& edge : graph.landmark_edges) {
    landmark_slot_.push_back(slot(layout_.pose_column[at(edge.pose)], layout_.landmark_column[at(edge.landmark)]));
  }
}

NormalEquations::Slot NormalEquations::slot(int column_a, int column_b) const {
  if (column_a < 0 || column_b < 0) return {};
  Slot slot;
  slot.row_column = std::min(column_a, column_b);
  slot.column = std::max(column_a, column_b);
  const auto begin = row_index.begin() + column_start[at(slot.column)];
  const auto end = row_index.begin() + column_start[at(slot.column) + 1];
  slot.offset = static_cast<int>(std::lower_bound(begin, end, slot.row_column) - begin);
  return slot;
}

}  // namespace helixnav::smoothing
