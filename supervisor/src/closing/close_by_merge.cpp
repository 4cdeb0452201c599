// SPDX-License-Identifier: BSD-3-Clause
#include "closing/close_by_merge.hpp"

#include "closing/branch_pairs.hpp"
#include "closing/duplicate_segment.hpp"

namespace helixnav::supervisor {

void merge_leftovers(cekf::CompressedEkf& filter, const DuplicateSegment& duplicate_segment,
                     const std::vector<core::LandmarkId>& confirmed, const std::vector<core::LandmarkId>& old,
                     const SearchOptions& options, Closing& closing) {
  constexpr int most_passes = 10;
  for (int pass = 0; pass < most_passes; ++pass) {
    KeptRemoved rest = leftovers(filter, confirmed, old, options);
    if (rest.empty()) rest = duplicate_segment.place(filter, old, options);
    Closing rest_closing;
    if (rest.empty() || !make_compatible(filter, options, rest, rest_closing)) return;
    filter.merge(rest, options.merge_sigma_m);
    note(rest, closing);
  }
}

Closing close_by_merge(cekf::CompressedEkf& filter, const std::vector<pf_relocalize::ConstellationPair>& pairs,
                       const Branch& branch, const std::vector<core::LandmarkId>& old, const SearchOptions& options) {
  Closing closing;
  const DuplicateSegment duplicate_segment(filter, branch);
  KeptRemoved chosen = kept_removed(pairs);
  if (chosen.size() < least_pairs || !make_compatible(filter, options, chosen, closing)) return closing;
  filter.merge(chosen, options.merge_sigma_m);
  note(chosen, closing);
  closing.accepted = true;

  merge_leftovers(filter, duplicate_segment, branch.confirmed, old, options, closing);
  forget_copies(filter, branch.unconfirmed, old, options, closing);
  return closing;
}

}  // namespace helixnav::supervisor
