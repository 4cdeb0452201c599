// SPDX-License-Identifier: BSD-3-Clause
// How a search begins, goes on, and ends with a closing or without one.
#include <algorithm>
#include <utility>
#include <vector>

#include "association/revisit_ambiguity.hpp"
#include "closing/close_map.hpp"
#include "closing/shape_evidence.hpp"
#include "closing/tied_by_view.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "loop/navigation_loop.hpp"
#include "slip/untied.hpp"

namespace helixnav::supervisor {

using core::LandmarkId;
using core::Scan;
using core::StepReport;

Search NavigationLoop::search_from(const association::LandmarkLife& existence, std::vector<LandmarkId> old) const {
  const std::uint64_t seed = options_.search.seed + 1000000u * searches_;
  return Search(std::move(old), existence.path_m(), seed,
                with_extraneous_density(options_.search, existence.born_per_scan(), view_));
}

void NavigationLoop::begin_search(const core::Scan& scan) {
  widen_for_search();
  ++searches_;
  Checkpoint trigger = take_checkpoint(belief_, tape_);
  Search search = search_from(trigger.existence,
                              old_or_drifted(belief_.filter, belief_.existence, scan, options_.search.old_after_m));
  belief_.seen_again.leave_out(search.old_landmarks());
  trigger.seen_again = belief_.seen_again;
  if (!undo_.mode) undo_.mode.emplace(std::move(mode_));
  mode_.emplace<Searching>(Searching{std::move(search), std::move(trigger), questions_});
}

/// Nothing is decided while everything may just have vanished: the vehicle would then not be where the branch has it.
void NavigationLoop::search(const Scan& scan, StepReport& report) {
  report.mode = core::Mode::searching;
  if (searching()->is_over || belief_.seen_again.is_suspicious()) return;
  Search& open = searching()->search;
  const auto pairs = open.look({belief_.filter, belief_.existence, belief_.coverage, scan}, report.decisions);
  report.cloud = open.cloud(belief_.filter);
  report.drawn = open.drawn(belief_.filter);
  if (pairs) close(scan, *pairs, report);
  if (searching() != nullptr && open.asks_shape()) close_by_shape(scan, report);
  const double path_m = belief_.existence.path_m();
  if (searching() == nullptr) return;
  if (!open.is_undecided(path_m)) {
    ask_meanwhile(scan, report);
    return;
  }
  const AskedWholeMap asked = ask_whole_map(scan, report);
  if (searching() == nullptr) return;
  const double driven_m = path_m - open.begun_path_m();
  if (asked.is_nowhere() && std::isinf(belief_.window.radius_m)) {
    report.decisions.emplace_back(core::NewGroundDecision{driven_m, asked.decision.landmarks});
  } else if (asks_whole_map() && !open.is_over(path_m)) {
    open.wait(path_m);
    return;
  } else {
    report.decisions.emplace_back(core::UndecidedDecision{driven_m});
  }
  if (!searching()->after_slip) belief_.left_open.push_back({open.begun_path_m(), path_m});
  end_search(nullptr);
}

/// If the landmarks, asked without the prior, decide for another place, that is believed instead of the search. After a slip there is
/// hardly a prior, and only what they decide without one is believed.
void NavigationLoop::close(const Scan& scan, const std::vector<pf_relocalize::ConstellationPair>& pairs,
                           StepReport& report) {
  const Searching& open = *searching();
  AskedWholeMap asked = ask_about_place(scan);
  const bool is_believed = !asked.is_elsewhere(pairs) && (asked.is_closed() || !open.after_slip);
  if (is_believed && close_as_measured(scan, pairs, report)) return;
  if (asked.is_closed() && close_at(asked.pairs, open.search, open.trigger, scan, asked.decision, report)) return;
  if (asked.is_asked()) report.decisions.emplace_back(asked.decision);
  searching()->search.refuse(belief_.existence.path_m());
}

/// Places that look alike from where the vehicle is may be told apart by the shape of all that was mapped since the search
/// began. A slip bends that, and no shape is believed then.
void NavigationLoop::close_by_shape(const Scan& scan, StepReport& report) {
  Search& search = searching()->search;
  if (belief_.slips.count > 0 || searching()->after_slip) return;
  const ClosingView view{search, belief_.existence, belief_.coverage, scan, {searching()->trigger, tape_}, 0.0};
  const Branch branch = branch_of(view, options_.search);
  std::vector<AlongBranch> places;
  for (const auto& pairs : search.contested()) {
    places.push_back(
        continued_along(belief_.filter, branch, search.old_landmarks(), kept_removed(pairs), options_.search));
  }
  const std::optional<core::ShapeDecision> decided = decided_by_shape(belief_.filter, places, options_.search);
  if (!decided) return;
  report.decisions.emplace_back(*decided);
  std::vector<pf_relocalize::ConstellationPair> pairs;
  for (const auto& [kept, removed] : places[static_cast<std::size_t>(decided->place)].pairs) {
    pairs.push_back({removed, kept});
  }
  if (search.pass(pairs)) close(scan, pairs, report);
}

bool NavigationLoop::close_as_measured(const Scan& scan, const std::vector<pf_relocalize::ConstellationPair>& pairs,
                                       StepReport& report) {
  const Searching& open = *searching();
  const core::Pose2 before = belief_.filter.pose().mean;
  const ClosingView view{open.search, belief_.existence,     belief_.coverage,
                         scan,        {open.trigger, tape_}, tied_if_slipping_m()};
  const Closing closing = close_map(belief_.filter, view, pairs, options_.search);
  report_closing(closing, pairs.size(), belief_.existence.path_m() - open.search.begun_path_m(), before, report);
  if (closing.accepted) accept(closing, view, report);
  return closing.accepted;
}

/// A vehicle that slips may have slipped where nothing was in view: what is beyond is tied by odometry alone.
double NavigationLoop::tied_if_slipping_m() const {
  if (belief_.slips.count == 0) return 0.0;
  return tied_since_m(tape_, belief_.existence.path_m(), options_.search.old_after_m);
}

/// The filter has been closed: closes everything else.
void NavigationLoop::accept(const Closing& closing, const ClosingView& view, StepReport& report) {
  const double begun_m = view.search.begun_path_m() - options_.search.old_after_m;
  if (view.tied_since_m > begun_m) belief_.left_open.push_back({begun_m, view.tied_since_m});
  for (const core::MergedLandmarks& one : closing.merged) belief_.existence.merge(one.kept, one.removed);
  for (const LandmarkId id : closing.forgotten) belief_.existence.remove(id);
  report.merged = closing.merged;
  pending_.odd_closing.excess = std::max(pending_.odd_closing.excess, closing.cost - closing.dof);
  if (belief_.untied_since_m && is_tied_by(closing.merged, belief_.existence, *belief_.untied_since_m)) {
    belief_.untied_since_m.reset();
  }
  tape_.append(Tape::Merge{closing.merged, closing.limit + closing.limit_of_leftovers});
  const double tied_m = view.tied_since_m;
  const core::FieldOfView field = view.scan.field_of_view;
  end_search(&closing);
  merge_left_open(field, tied_m, report);
  solve_drive(report);
  merge_mapped_twice(report);
}

void NavigationLoop::report_closing(const Closing& closing, std::size_t pairs, double driven_m,
                                    const core::Pose2& before, StepReport& report) const {
  core::ClosureDecision decision;
  decision.accepted = closing.accepted;
  decision.pairs = static_cast<int>(pairs);
  decision.dropped = closing.dropped;
  decision.merged = static_cast<int>(closing.merged.size());
  decision.cost = closing.cost;
  decision.dof = closing.dof;
  decision.limit = closing.limit;
  decision.driven_m = driven_m;
  decision.moved_m = (belief_.filter.pose().mean.position_m() - before.position_m()).norm();
  report.decisions.emplace_back(decision);
  report.numerics.note(closing.numerics);
}

/// Mapping continues with the whole map; the landmarks recognised by a closing confirm the pose.
void NavigationLoop::end_search(const Closing* closing) {
  Mapping mapping;
  if (closing != nullptr) {
    std::vector<LandmarkId> recognised;
    for (const core::MergedLandmarks& one : closing->merged) recognised.push_back(one.kept);
    mapping.monitor.close(belief_.existence.path_m(), recognised);
  }
  if (!undo_.mode) undo_.mode.emplace(std::move(mode_));
  mode_.emplace<Mapping>(std::move(mapping));
}

}  // namespace helixnav::supervisor
