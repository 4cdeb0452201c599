// SPDX-License-Identifier: BSD-3-Clause
// What was mapped in searches that ended undecided may be copies; a closing tells where the vehicle was then.
#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "closing/close_by_merge.hpp"
#include "closing/duplicate_segment.hpp"
#include "closing/mapped_twice.hpp"
#include "closing/tied_by_view.hpp"
#include "loop/navigation_loop.hpp"

namespace helixnav::supervisor {
namespace {

/// The landmarks of the segment as a branch of their own, beside everything mapped before it.
Branch branch_of(const Belief& belief, const LeftOpen& segment, const core::FieldOfView& view, int least_hits) {
  Branch branch;
  for (const association::LandmarkRecord& record : belief.existence.records()) {
    const bool in_segment = record.born_path_m > segment.begun_path_m && record.born_path_m <= segment.ended_path_m;
    if (in_segment && record.hits >= least_hits) branch.confirmed.push_back(record.id);
  }
  branch.old_drive.T_frame_sensor = belief.coverage.between(0.0, segment.begun_path_m);
  branch.new_drive.T_frame_sensor = belief.coverage.between(segment.begun_path_m, segment.ended_path_m + 1e-9);
  branch.old_drive.field_of_view = branch.new_drive.field_of_view = view;
  branch.new_drive.least_views = 2;
  branch.appearance = belief.existence.appearance();
  return branch;
}

std::vector<core::LandmarkId> mature_before(double path_m, const association::LandmarkLife& existence) {
  std::vector<core::LandmarkId> ids;
  for (const association::LandmarkRecord& record : existence.records()) {
    if (record.born_path_m <= path_m && record.state == core::LandmarkState::mature) ids.push_back(record.id);
  }
  return ids;
}

std::vector<core::LandmarkId> mature_in(const cekf::CompressedEkf& filter, const association::LandmarkLife& existence) {
  std::vector<core::LandmarkId> ids;
  for (const association::LandmarkRecord& record : existence.records()) {
    const bool is_mature = record.state == core::LandmarkState::mature;
    if (is_mature && filter.contains(record.id)) ids.push_back(record.id);
  }
  return ids;
}

/// As many copies as make a constellation, and most of what is now on ground that was mapped before: in a lattice a few
/// fit anywhere.
bool are_most_copies(const Closing& closing, const Branch& branch, const cekf::CompressedEkf& filter,
                     const SearchOptions& options) {
  std::size_t alone = 0;
  for (const core::LandmarkId id : branch.confirmed) {
    alone += filter.contains(id) && branch.old_drive.covers(filter.landmark_mean(id)) ? 1 : 0;
  }
  return closing.merged.size() > alone &&
         closing.merged.size() >= static_cast<std::size_t>(options.constellation.least_matches);
}

/// The landmarks that views do not tie to the present.
Branch beyond(const Branch& branch, const std::vector<core::LandmarkId>& tied) {
  Branch rest = branch;
  rest.confirmed.clear();
  std::set_difference(branch.confirmed.begin(), branch.confirmed.end(), tied.begin(), tied.end(),
                      std::back_inserter(rest.confirmed));
  return rest;
}

Closing merge_copies(cekf::CompressedEkf& filter, const Branch& branch, const std::vector<core::LandmarkId>& old,
                     const SearchOptions& options) {
  Closing closing;
  if (branch.confirmed.empty()) return closing;
  merge_leftovers(filter, DuplicateSegment(filter, branch), branch.confirmed, old, options, closing);
  return closing;
}

}  // namespace

/// After a closing: merges what it shows to be copies, by the rules for a closing's leftovers. Of what was mapped
/// before `tied_since_m`, either most is merged or nothing: odometry that was wrong somewhere says too little about
/// where it is.
void NavigationLoop::merge_left_open(const core::FieldOfView& view, double tied_since_m, core::StepReport& report) {
  for (const LeftOpen& segment : belief_.left_open) {
    Branch tied = branch_of(belief_, segment, view, options_.search.constellation.least_hits);
    const std::vector<core::LandmarkId> ids = seen_since(tied_since_m, belief_.existence, tied.confirmed);
    const Branch rest = beyond(tied, ids);
    tied.confirmed = ids;
    const std::vector<core::LandmarkId> old = mature_before(segment.begun_path_m, belief_.existence);
    note_merged(merge_copies(belief_.filter, tied, old, options_.search), report);
    if (rest.confirmed.empty()) continue;
    cekf::CompressedEkf before = belief_.filter;
    const Closing closing = merge_copies(belief_.filter, rest, old, options_.search);
    if (!are_most_copies(closing, rest, belief_.filter, options_.search)) {
      std::swap(belief_.filter, before);
      continue;
    }
    note_merged(closing, report);
  }
}

/// Once the drive is solved, copies are where their landmark is, also those that were left over by this closing and by earlier
/// ones, among which a copy made later has more than one to be merged with.
void NavigationLoop::merge_mapped_twice(core::StepReport& report) {
  constexpr int most_passes = 10;
  const core::MapAppearance& appearance = belief_.existence.appearance();
  for (int pass = 0; pass < most_passes; ++pass) {
    Closing closing;
    KeptRemoved pairs =
        mapped_twice(belief_.filter, mature_in(belief_.filter, belief_.existence), options_.search, appearance);
    if (pairs.empty() || !make_compatible(belief_.filter, options_.search, pairs, closing)) return;
    if (!try_merge(belief_.filter, pairs, options_.search.merge_sigma_m)) {
      ++report.numerics.refused;
      return;
    }
    note(pairs, closing);
    closing.limit_of_leftovers = closing.limit;
    note_merged(closing, report);
  }
}

void NavigationLoop::note_merged(const Closing& closing, core::StepReport& report) {
  report.numerics.note(closing.numerics);
  if (closing.merged.empty()) return;
  for (const core::MergedLandmarks& one : closing.merged) belief_.existence.merge(one.kept, one.removed);
  report.merged.insert(report.merged.end(), closing.merged.begin(), closing.merged.end());
  tape_.append(Tape::Merge{closing.merged, closing.limit_of_leftovers});
}

}  // namespace helixnav::supervisor
