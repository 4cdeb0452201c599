// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "closing/closing.hpp"
#include "closing/duplicate_segment.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/pf_relocalize/constellation.hpp"
#include "helixnav/supervisor/search_options.hpp"

namespace helixnav::supervisor {

/// Conditions the map on every branch landmark of the pairs being its old partner, jointly and iterated; the worst pair
/// is dropped while the cost exceeds its χ² limit. Then whatever else of the branch has become a duplicate of one of `old`
/// (ascending) is merged under a joint gate of its own, and unconfirmed copies are removed. If refused: filter as before.
/// Exact: equal to a full EKF given the same equalities. Source: PROTOTYPE §6. Test: supervisor/closing/closing_test.cpp.
Closing close_by_merge(cekf::CompressedEkf& filter, const std::vector<pf_relocalize::ConstellationPair>& pairs,
                       const Branch& branch, const std::vector<core::LandmarkId>& old, const SearchOptions& options);

/// Merges what has become a copy, in passes: each draws the branch nearer to the old map, so that copies farther along
/// come within reach in the next; where single copies are ambiguous, a whole segment is aligned (DuplicateSegment).
/// Adds to `closing`. Test: supervisor/closing/closing_test.cpp, supervisor/lattice_test.cpp.
void merge_leftovers(cekf::CompressedEkf& filter, const DuplicateSegment& duplicate_segment,
                     const std::vector<core::LandmarkId>& confirmed, const std::vector<core::LandmarkId>& old,
                     const SearchOptions& options, Closing& closing);

}  // namespace helixnav::supervisor
