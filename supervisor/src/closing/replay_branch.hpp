// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "loop/belief.hpp"
#include "loop/tape.hpp"

namespace helixnav::supervisor {

/// What was done to the filter since a search began: the checkpoint of its trigger and the tape from there on.
struct BranchRecord {
  const Checkpoint& trigger;
  const Tape& tape;
};

/// Landmarks begun by scans of the branch.
std::set<core::LandmarkId> born_in(const BranchRecord& branch);

/// Restores the filter to the trigger and processes everything again, with each branch landmark in `old_of` replaced by
/// the old one from its birth on; scans that see one of these are iterated. Every other landmark keeps its id. Returns
/// the cost, to be compared with innovation_cost of the branch. Throws what the filter throws, which is then left
/// part-way. Cost: a few times that of the scans themselves. Test: supervisor/closing/replay_test.cpp.
cekf::UpdateResult replay_branch(cekf::CompressedEkf& filter, const BranchRecord& branch,
                                 const std::map<core::LandmarkId, core::LandmarkId>& old_of);

}  // namespace helixnav::supervisor
