// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "cholesky.hpp"

namespace helixnav::smoothing {

/// Z = (L·Lᵀ)⁻¹ on the pattern of L, computed only in the columns on the elimination tree's paths from the chosen columns
/// to the root (Takahashi's recursion: Z_kj = −Σ_{i>j} Z_ki·L_ij / L_jj below the diagonal, Z_jj = (1/L_jj − Σ Z_ij·L_ij) / L_jj).
/// Indices are positions in the elimination order. Cost: the sum, over those columns, of the lengths of the columns
/// that each of them refers to.
class SelectedInverse {
 public:
  SelectedInverse(const FactorView& L, const std::vector<int>& chosen_positions);

  /// Z at two positions of the elimination order; the pair must lie in L's pattern and the earlier position on a path.
  double at(int a, int b) const;

 private:
  void compute_column(const FactorView& L, int j);

  FactorView L_;
  std::vector<double> Z_;     ///< stored like L's values
  std::vector<double> l_;     ///< work: L_ij of the present column, 0 elsewhere
  std::vector<double> sums_;  ///< work: Σ Z_ki·L_ij
};

}  // namespace helixnav::smoothing
