// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/pf_relocalize/constellation.hpp"

namespace helixnav::supervisor {

/// The pairs whose old landmarks are in one piece of the map. If the relative position of two pieces is not known to
/// half of the landmarks' spacing, as after a search that stayed undecided, a few pairs of another piece would fix it:
/// in a grid a neighbour's position fits as well, and χ² of the many others hides them. Old landmarks are in one piece
/// if a chain leads from one to the other in which each is known relative to the next to half of the branch landmarks'
/// median distance to their nearest; pairs of pieces with less than half as many as the largest are left out. In the
/// order given. O(pairs²).
/// Test: supervisor/closing/tied_pairs_test.cpp.
std::vector<pf_relocalize::ConstellationPair> tied_pairs(const cekf::CompressedEkf& filter,
                                                         const std::vector<pf_relocalize::ConstellationPair>& pairs);

}  // namespace helixnav::supervisor
