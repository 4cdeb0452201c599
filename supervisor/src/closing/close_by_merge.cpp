// SPDX-License-Identifier: BSD-3-Clause
#include "closing/close_by_merge.hpp"

#include "closing/branch_pairs.hpp"
#include "closing/duplicate_segment.hpp"

namespace helixnav::supervisor {
namespace {

Closing refused_for_rounding(Closing closing) {
  closing.cost = closing.limit = 0.0;
  closing.dof = 0;
  ++closing.numerics.refused;
  return closing;
}

}  // namespace

void merge_leftovers(cekf::CompressedEkf& filter, const DuplicateSegment& duplicate_segment,
                     const std::vector<core::LandmarkId>& confirmed, const std::vector<core::LandmarkId>& old,
                     const SearchOptions& options, Closing& closing) {
  constexpr int most_passes = 10;
  for (int pass = 0; pass < most_passes; ++pass) {
    KeptRemoved rest = leftovers(filter, confirmed, old, options, duplicate_segment.appearance());
    if (rest.empty()) rest = duplicate_segment.place(filter, old, options);
    Closing rest_closing;
    if (rest.empty() || !make_compatible(filter, options, rest, rest_closing)) return;
    if (!try_merge(filter, rest, options.merge_sigma_m)) {
      ++closing.numerics.refused;
      return;
    }
    closing.limit_of_leftovers += rest_closing.limit;
    note(rest, closing);
  }
}

Closing close_by_merge(cekf::CompressedEkf& filter, const std::vector<pf_relocalize::ConstellationPair>& pairs,
                       const Branch& branch, const std::vector<core::LandmarkId>& old, const SearchOptions& options) {
  Closing closing;
  const DuplicateSegment duplicate_segment(filter, branch);
  KeptRemoved chosen = kept_removed(pairs);
  if (chosen.size() < least_pairs || !make_compatible(filter, options, chosen, closing)) return closing;
  if (!try_merge(filter, chosen, options.merge_sigma_m)) return refused_for_rounding(closing);
  note(chosen, closing);
  closing.accepted = true;

  merge_leftovers(filter, duplicate_segment, branch.confirmed, old, options, closing);
  forget_copies(filter, branch.unconfirmed, old, options, closing, branch.appearance);
  return closing;
}

}  // namespace helixnav::supervisor
