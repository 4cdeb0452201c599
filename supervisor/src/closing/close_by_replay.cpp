// SPDX-License-Identifier: BSD-3-Clause
#include "closing/close_by_replay.hpp"

#include <map>
#include <set>
#include <utility>

#include "closing/branch_pairs.hpp"
#include "closing/close_by_merge.hpp"
#include "closing/duplicate_segment.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::supervisor {
namespace {

/// Replays the filter with the pairs; false, with the filter left part-way, if it cannot accept them.
bool replay(cekf::CompressedEkf& filter, const BranchRecord& record, const KeptRemoved& pairs,
            const SearchOptions& options, Closing& closing) {
  const std::set<core::LandmarkId> born = born_in(record);
  const cekf::UpdateResult before = innovation_cost(record.tape, record.trigger.position);
  std::map<core::LandmarkId, core::LandmarkId> old_of;
  KeptRemoved older;  // than the branch
  for (const auto& [kept, removed] : pairs) {
    if (born.count(removed) > 0) {
      old_of[removed] = kept;
    } else {
      older.emplace_back(kept, removed);
    }
  }
  try {
    const cekf::UpdateResult again = replay_branch(filter, record, old_of);
    const cekf::UpdateResult merged = filter.merge(older, options.merge_sigma_m);
    closing.cost = again.nis + merged.nis - before.nis;
    closing.dof = again.dof + merged.dof - before.dof;
  } catch (const core::NumericalError&) {
    ++closing.numerics.refused;
    return false;
  }
  closing.limit = core::chi2_quantile(options.closing_probability, closing.dof);
  return closing.cost <= closing.limit;
}

/// Replays with more and more pairs, as long as the filter accepts them; true if there are no more.
bool replay_leftovers(cekf::CompressedEkf& filter, const DuplicateSegment& duplicate_segment,
                      const BranchRecord& record, const Branch& branch, const std::vector<core::LandmarkId>& old,
                      const SearchOptions& options, KeptRemoved& pairs, Closing& closing) {
  constexpr int most_passes = 10;
  for (int pass = 0; pass < most_passes; ++pass) {
    KeptRemoved rest = leftovers(filter, branch.confirmed, old, options, branch.appearance);
    if (rest.empty()) rest = duplicate_segment.place(filter, old, options);
    Closing next = closing;
    next.dropped = 0;
    if (rest.empty() || !make_compatible(filter, options, rest, next)) return true;
    rest.insert(rest.begin(), pairs.begin(), pairs.end());
    const cekf::CompressedEkf before = filter;
    if (!replay(filter, record, rest, options, next)) {
      filter = before;
      return false;
    }
    next.dropped = closing.dropped;
    closing = next;
    pairs = std::move(rest);
  }
  return true;
}

}  // namespace

Closing replay_with_pairs(cekf::CompressedEkf& filter, const BranchRecord& record, KeptRemoved chosen,
                          const Branch& branch, const std::vector<core::LandmarkId>& old, const SearchOptions& options,
                          Closing closing) {
  const DuplicateSegment duplicate_segment(filter, branch);
  const cekf::CompressedEkf before = filter;
  if (!replay(filter, record, chosen, options, closing)) {
    filter = before;
    return closing;
  }
  closing.accepted = true;
  const bool complete = replay_leftovers(filter, duplicate_segment, record, branch, old, options, chosen, closing);
  note(chosen, closing);
  if (!complete) merge_leftovers(filter, duplicate_segment, branch.confirmed, old, options, closing);
  forget_copies(filter, branch.unconfirmed, old, options, closing, branch.appearance);
  return closing;
}

Closing close_by_replay(cekf::CompressedEkf& filter, const BranchRecord& record,
                        const std::vector<pf_relocalize::ConstellationPair>& pairs, const Branch& branch,
                        const std::vector<core::LandmarkId>& old, const SearchOptions& options) {
  Closing closing;
  KeptRemoved chosen = kept_removed(pairs);
  if (chosen.size() < least_pairs || !make_compatible(filter, options, chosen, closing)) return closing;
  return replay_with_pairs(filter, record, std::move(chosen), branch, old, options, closing);
}

}  // namespace helixnav::supervisor
