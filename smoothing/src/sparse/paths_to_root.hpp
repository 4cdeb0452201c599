// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "cholesky.hpp"

namespace helixnav::smoothing {

/// In the elimination tree; −1 at a root.
inline int parent(const FactorView& L, int j) { return L.column_size[j] > 1 ? L.row_index[L.column_start[j] + 1] : -1; }

/// Marks the columns on the elimination tree's paths from the chosen ones to the root.
inline std::vector<char> columns_on_paths(const FactorView& L, const std::vector<int>& chosen_positions) {
  std::vector<char> wanted(static_cast<std::size_t>(L.columns), 0);
  for (int j : chosen_positions) {
    for (; j >= 0 && !wanted[static_cast<std::size_t>(j)]; j = parent(L, j)) wanted[static_cast<std::size_t>(j)] = 1;
  }
  return wanted;
}

}  // namespace helixnav::smoothing
