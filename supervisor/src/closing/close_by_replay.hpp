// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "closing/branch_pairs.hpp"
#include "closing/closing.hpp"
#include "closing/replay_branch.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/pf_relocalize/constellation.hpp"
#include "helixnav/supervisor/search_options.hpp"

namespace helixnav::supervisor {

/// Goes back to where the search began and processes its scans again, with each branch landmark of the pairs replaced
/// by its old partner; then again with whatever else of the branch has become a duplicate of one of `old` (ascending),
/// until nothing new does. Pairs are chosen as by close_by_merge. The cost of the pairs is the excess of the replay's
/// cost over the branch's: to first order the J of merging them. Refused, with the filter as before, if it exceeds its
/// χ² limit or an iteration does not converge. A branch landmark older than the trigger is merged after the replay, and
/// so are the duplicates if the replay with them costs too much.
/// Exact: equal to a full EKF given the same associations. Test: supervisor/closing/replay_test.cpp.
Closing close_by_replay(cekf::CompressedEkf& filter, const BranchRecord& record,
                        const std::vector<pf_relocalize::ConstellationPair>& pairs, const Branch& branch,
                        const std::vector<core::LandmarkId>& old, const SearchOptions& options);

/// The same with pairs that were chosen already; `closing` holds how many were dropped.
Closing replay_with_pairs(cekf::CompressedEkf& filter, const BranchRecord& record, KeptRemoved chosen,
                          const Branch& branch, const std::vector<core::LandmarkId>& old, const SearchOptions& options,
                          Closing closing);

}  // namespace helixnav::supervisor
