// SPDX-License-Identifier: BSD-3-Clause
#include "closing/close_map.hpp"

#include <limits>

#include "closing/agreed_pairs.hpp"
#include "closing/close_by_merge.hpp"
#include "closing/close_by_replay.hpp"
#include "closing/close_by_restart.hpp"
#include "closing/tied_by_view.hpp"
#include "closing/tied_pairs.hpp"

namespace helixnav::supervisor {
namespace {

std::vector<core::LandmarkId> mapped_since(double path_m, const association::LandmarkLife& life) {
  std::vector<core::LandmarkId> since;
  for (const association::LandmarkRecord& record : life.records()) {
    if (record.born_path_m > path_m) since.push_back(record.id);
  }
  return since;
}

}  // namespace

Branch branch_of(const ClosingView& view, const SearchOptions& options) {
  Branch branch;
  const double left_old_ground_m = view.search.begun_path_m() - options.old_after_m;
  for (const association::LandmarkRecord& record : view.life.records()) {
    if (record.last_seen_path_m <= left_old_ground_m || view.search.excludes(record.id)) continue;
    const bool confirmed = record.hits >= options.constellation.least_hits;
    (confirmed ? branch.confirmed : branch.unconfirmed).push_back(record.id);
  }
  branch.old_drive.T_frame_sensor = view.coverage.between(0.0, left_old_ground_m);
  branch.old_drive.field_of_view = view.scan.field_of_view;
  branch.new_drive.T_frame_sensor = view.coverage.between(left_old_ground_m, std::numeric_limits<double>::infinity());
  branch.new_drive.field_of_view = view.scan.field_of_view;
  branch.new_drive.least_views = 2;
  branch.confirmed = seen_since(view.tied_since_m, view.life, branch.confirmed);
  branch.appearance = view.life.appearance();
  return branch;
}

Closing close_map(cekf::CompressedEkf& filter, const ClosingView& view,
                  const std::vector<pf_relocalize::ConstellationPair>& all_pairs, const SearchOptions& options) {
  const Search& search = view.search;
  if (options.closing == ClosingMethod::restart) {
    return close_by_restart(filter, mapped_since(search.begun_path_m(), view.life),
                            search.heaviest_mode(filter).value_or(filter.pose()));
  }
  const Branch branch = branch_of(view, options);
  const std::vector<pf_relocalize::ConstellationPair> pairs =
      agreed_pairs(filter, branch, search.old_landmarks(), tied_pairs(filter, all_pairs), options);
  if (options.closing == ClosingMethod::replay) {
    Closing closing = close_by_replay(filter, view.record, pairs, branch, search.old_landmarks(), options);
    if (closing.accepted) return closing;
    Closing merged = close_by_merge(filter, pairs, branch, search.old_landmarks(), options);
    if (merged.accepted) merged.numerics.repaired += closing.numerics.refused;
    return merged;
  }
  return close_by_merge(filter, pairs, branch, search.old_landmarks(), options);
}

}  // namespace helixnav::supervisor
