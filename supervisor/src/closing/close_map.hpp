// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "closing/closing.hpp"
#include "closing/replay_branch.hpp"
#include "helixnav/association/landmark_life.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "loop/coverage_trace.hpp"
#include "search/search.hpp"

namespace helixnav::supervisor {

/// The input of a closing, besides the filter.
struct ClosingView {
  const Search& search;
  const association::LandmarkLife& life;
  const CoverageTrace& coverage;
  const core::Scan& scan;
  BranchRecord record;
  /// Only what was seen of the branch since that length of the drive is merged (tied_by_view.hpp).
  double tied_since_m = 0.0;
};

/// The landmarks mapped since the search began, and the ground that both drives covered.
Branch branch_of(const ClosingView& view, const SearchOptions& options);

/// Closes the map with the pairs that the search has found, by the method of SearchOptions::closing. A closing whose cost
/// exceeds its χ² limit is refused (make_compatible in branch_pairs.cpp), and leaves the filter as it was.
/// Test: supervisor/closing/closing_test.cpp, supervisor/closing/replay_test.cpp, supervisor/lattice_test.cpp.
Closing close_map(cekf::CompressedEkf& filter, const ClosingView& view,
                  const std::vector<pf_relocalize::ConstellationPair>& pairs, const SearchOptions& options);

}  // namespace helixnav::supervisor
