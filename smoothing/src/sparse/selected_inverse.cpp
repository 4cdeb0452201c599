// SPDX-License-Identifier: BSD-3-Clause
#include "selected_inverse.hpp"

#include <algorithm>

#include "helixnav/core/errors.hpp"
#include "paths_to_root.hpp"

namespace helixnav::smoothing {

SelectedInverse::SelectedInverse(const FactorView& L, const std::vector<int>& chosen_positions)
    : L_(L),
      Z_(static_cast<std::size_t>(L.columns > 0 ? L.column_start[L.columns - 1] + L.column_size[L.columns - 1] : 0)),
      l_(static_cast<std::size_t>(L.columns), 0.0),
      sums_(static_cast<std::size_t>(L.columns), 0.0) {
  const std::vector<char> wanted = columns_on_paths(L, chosen_positions);
  for (int j = L.columns - 1; j >= 0; --j) {
    if (wanted[static_cast<std::size_t>(j)]) compute_column(L, j);
  }
}

void SelectedInverse::compute_column(const FactorView& L, int j) {
  const int begin = L.column_start[j];
  const int end = begin + L.column_size[j];
  const double pivot = L.values[begin];
  for (int p = begin + 1; p < end; ++p) {
    l_[static_cast<std::size_t>(L.row_index[p])] = L.values[p];
    sums_[static_cast<std::size_t>(L.row_index[p])] = 0.0;
  }
  // Rows of column j beyond its first are rows of its later columns too, so every Z_ki needed lies in L's pattern. Rows
  // that are not in column j meet l_ = 0 or a sum that is never read.
  for (int p = begin + 1; p < end; ++p) {
    const int i = L.row_index[p];
    const double l_i = L.values[p];
    const int i_begin = L.column_start[i];
    const int i_end = i_begin + L.column_size[i];
    double sum = Z_[static_cast<std::size_t>(i_begin)] * l_i;
    for (int q = i_begin + 1; q < i_end; ++q) {
      const std::size_t k = static_cast<std::size_t>(L.row_index[q]);
      const double z = Z_[static_cast<std::size_t>(q)];
      sum += z * l_[k];
      sums_[k] += z * l_i;
    }
    sums_[static_cast<std::size_t>(i)] += sum;
  }
  double diagonal = 1.0 / pivot;
  for (int p = begin + 1; p < end; ++p) {
    const std::size_t i = static_cast<std::size_t>(L.row_index[p]);
    const double z = -sums_[i] / pivot;
    Z_[static_cast<std::size_t>(p)] = z;
    diagonal -= z * L.values[p];
    l_[i] = 0.0;
  }
  Z_[static_cast<std::size_t>(begin)] = diagonal / pivot;
}

double SelectedInverse::at(int a, int b) const {
  const int j = std::min(a, b);
  const int row = std::max(a, b);
  const int* begin = L_.row_index + L_.column_start[j];
  const int* end = begin + L_.column_size[j];
  const int* found = std::lower_bound(begin, end, row);
  if (found == end || *found != row) {
    throw core::PreconditionError("SelectedInverse: the pair is not in the factor's pattern");
  }
  return Z_[static_cast<std::size_t>(found - L_.row_index)];
}

}  // namespace helixnav::smoothing
