// SPDX-License-Identifier: BSD-3-Clause
// What was mapped in searches that ended undecided may be copies; a closing tells where the vehicle was then.
#include <utility>
#include <vector>

#include "closing/close_by_merge.hpp"
#include "closing/duplicate_segment.hpp"
#include "loop/navigation_loop.hpp"

namespace helixnav::supervisor {
namespace {

/// The landmarks of the segment as a branch of their own, beside all that was mapped before it.
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

}  // namespace

/// After a closing: merges what it shows to be copies, by the rules for what a closing leaves over.
void NavigationLoop::merge_left_open(const core::FieldOfView& view, core::StepReport& report) {
  for (const LeftOpen& segment : belief_.left_open) {
    const Branch branch = branch_of(belief_, segment, view, options_.search.constellation.least_hits);
    if (branch.confirmed.empty()) continue;
    const std::vector<core::LandmarkId> old = mature_before(segment.begun_path_m, belief_.existence);
    Closing closing;
    merge_leftovers(belief_.filter, DuplicateSegment(belief_.filter, branch), branch.confirmed, old, options_.search,
                    closing);
    report.numerics.note(closing.numerics);
    if (closing.merged.empty()) continue;
    for (const core::MergedLandmarks& one : closing.merged) belief_.existence.merge(one.kept, one.removed);
    report.merged.insert(report.merged.end(), closing.merged.begin(), closing.merged.end());
    tape_.append(Tape::Merge{std::move(closing.merged), closing.limit_of_leftovers});
  }
}

}  // namespace helixnav::supervisor
