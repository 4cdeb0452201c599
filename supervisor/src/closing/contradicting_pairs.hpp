// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "closing/branch_pairs.hpp"

namespace helixnav::supervisor {

/// How many pairs may be left out.
struct MayLeaveOut {
  std::size_t any = 0;       ///< whatever they are, and …
  std::size_t outliers = 0;  ///< … more that the rest contradicts, as it does one right pair in 1000
};

/// Indices in `pairs`, ascending, of those to leave out so that χ² of the rest is within its quantile: the pair without
/// which χ² falls most goes first, and at least least_pairs stay. Linearised at the filter's estimate: the remaining
/// pairs are still to be solved (merge_cost). One factorisation for all, O(pairs³), and O(pairs²) for each pair left
/// out. Source: S⁻¹ of fewer rows by its Schur complement. Test: supervisor/closing/contradicting_pairs_test.cpp
/// (against solving again after each).
std::vector<std::size_t> contradicting_pairs(const cekf::CompressedEkf& filter, const KeptRemoved& pairs,
                                             double sigma_m, double closing_probability, MayLeaveOut may);

}  // namespace helixnav::supervisor
