// SPDX-License-Identifier: BSD-3-Clause
// Correlations kept within groups of near landmarks, bounded there.
#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/pf_relocalize/conservative_bound.hpp"

namespace helixnav::pf_relocalize {

std::vector<std::vector<int>> constellations(const std::vector<Eigen::Vector2d>& points_m, int size) {
  if (size < 1) throw core::PreconditionError("constellations: size must be at least 1");
  std::vector<int> all(points_m.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<std::vector<int>> open{all}, done;
  while (!open.empty()) {
    std::vector<int> group = std::move(open.back());
    open.pop_back();
    if (group.size() <= static_cast<std::size_t>(size)) {
      if (!group.empty()) done.push_back(std::move(group));
      continue;
    }
    Eigen::Vector2d low = points_m[static_cast<std::size_t>(group.front())], high = low;
    for (const int i : group) {
      low = low.cwiseMin(points_m[static_cast<std::size_t>(i)]);
      high = high.cwiseMax(points_m[static_cast<std::size_t>(i)]);
    }
    const int axis = high.x() - low.x() >= high.y() - low.y() ? 0 : 1;
    std::sort(group.begin(), group.end(), [&](int i, int j) {
      return points_m[static_cast<std::size_t>(i)][axis] < points_m[static_cast<std::size_t>(j)][axis];
    });
    const auto middle = group.begin() + static_cast<std::ptrdiff_t>(group.size() / 2);
    open.emplace_back(middle, group.end());
    open.emplace_back(group.begin(), middle);
  }
  return done;
}

Blocks constellation_bound(const Eigen::Ref<const Eigen::MatrixXd>& P, const std::vector<std::vector<int>>& groups,
                           int sweeps) {
  Blocks blocks = diagonal_blocks(P);
  for (const std::vector<int>& group : groups) {
    const auto n = static_cast<Eigen::Index>(group.size());
    Eigen::MatrixXd marginal(2 * n, 2 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        marginal.block<2, 2>(2 * i, 2 * j) =
            P.block<2, 2>(2 * group[static_cast<std::size_t>(i)], 2 * group[static_cast<std::size_t>(j)]);
      }
    }
    const Blocks bound = whitened_bound(marginal, sweeps);
    for (std::size_t i = 0; i < group.size(); ++i) blocks[static_cast<std::size_t>(group[i])] = bound[i];
  }
  return blocks;
}

}  // namespace helixnav::pf_relocalize
