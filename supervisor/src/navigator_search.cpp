// SPDX-License-Identifier: BSD-3-Clause
// The Navigator's open question: how a search begins, goes on, and ends with a closing or without.
#include <limits>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "ambiguous_return.hpp"
#include "branch_journal.hpp"
#include "close_map.hpp"
#include "drive_log.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "helixnav/supervisor/navigator.hpp"
#include "history.hpp"
#include "missing_spawn.hpp"
#include "search.hpp"
#include "smooth_drive.hpp"
#include "track.hpp"

namespace helixnav::supervisor {

using core::LandmarkId;
using core::Scan;
using core::StepReport;

void Navigator::keep_in_mind(const Scan& scan, const StepReport& report) {
  if (search_ || !options_.search.enabled || !options_.search.missing_spawn.enabled) return;
  history_->note(scan);
  const bool out_of_reach = !history_->empty() && report.step - history_->step() > options_.search.missing_spawn.reach;
  if (out_of_reach) *doubts_ = MissingSpawn();
  if (doubts_->is_clear()) history_->settle(report.step, filter_, life_);
}

bool Navigator::has_got_lost() const {
  return !history_->empty() && doubts_->is_lost(life_, options_.search.missing_spawn);
}

/// The search that should have begun when the pose was last vouched for: what came since is gone through again in it.
StepReport Navigator::search_from_before(StepReport report) {
  const MissingSpawn::Evidence evidence = doubts_->evidence(life_, options_.search.missing_spawn);
  const LandmarkId next = filter_.next_name();
  const std::int64_t rewound_to = history_->step();
  const std::vector<History::Event> since = history_->rewind(filter_, life_);
  filter_.name_from(next);
  track_->back_to(life_.path_m());
  drive_->back_to(rewound_to);
  step_ = rewound_to + 1;
  decisions_ = std::move(report.decisions);
  decisions_.push_back({"trigger",
                        "rewound",
                        {{"missing", evidence.missing},
                         {"seen", evidence.seen},
                         {"spawned", evidence.spawned},
                         {"nats", evidence.nats},
                         {"scans", static_cast<double>(report.step - rewound_to)}}});
  begin_search();
  StepReport through;
  for (const History::Event& event : since) {
    if (const auto* motion = std::get_if<History::Motion>(&event)) {
      motion_ = motion->odometry;
      driven_m_ = motion->driven_m;
    } else if (const auto* absolute = std::get_if<core::AbsoluteFix>(&event)) {
      fix(*absolute);
      decisions_.pop_back();  // it was reported when it came in
    } else {
      report = navigate(std::get<Scan>(event));
      through.decisions.insert(through.decisions.end(), report.decisions.begin(), report.decisions.end());
      through.merged.insert(through.merged.end(), report.merged.begin(), report.merged.end());
      through.revised.push_back({report.step, report.associations});
    }
  }
  through.revised.pop_back();  // the last one is this scan
  report.decisions = std::move(through.decisions);
  report.merged = std::move(through.merged);
  report.revised = std::move(through.revised);
  return report;
}

void Navigator::begin_search() {
  history_->clear(filter_);
  *doubts_ = MissingSpawn();
  const std::uint64_t seed = options_.search.seed + 1000000u * ++searches_;
  search_ = std::make_unique<Search>(old_landmarks(life_, options_.search.old_after_m), life_.path_m(), seed,
                                     with_foreign(options_.search, life_.born_per_scan(), view_));
  if (options_.search.closing == ClosingMethod::replay) journal_ = std::make_unique<BranchJournal>(filter_);
}

void Navigator::end_search() {
  search_.reset();
  journal_.reset();
  filter_.keep_since(std::numeric_limits<long>::max());
}

void Navigator::pursue_search(const Scan& scan, StepReport& report) {
  const auto pairs = search_->look({filter_, life_, *track_, scan}, report.decisions);
  report.cloud = search_->cloud(filter_);
  report.drawn = search_->drawn(filter_);
  report.mode = core::Mode::searching;
  if (pairs) close(scan, *pairs, report);
  if (!search_ || !search_->is_undecided(life_.path_m())) return;
  report.decisions.push_back({"closure", "undecided", {{"driven_m", life_.path_m() - search_->begun_path_m()}}});
  end_search();
}

void Navigator::close(const Scan& scan, const std::vector<pf_relocalize::ConstellationPair>& pairs,
                      StepReport& report) {
  const core::Pose2 before = filter_.pose().mean;
  const Closing closing = close_map(filter_, {*search_, life_, *track_, scan, journal_.get()}, pairs, options_.search);
  for (const core::MergedLandmarks& one : closing.merged) life_.merge(one.kept, one.removed);
  for (const LandmarkId id : closing.forgotten) life_.remove(id);
  report.merged = closing.merged;
  report.decisions.push_back({"closure",
                              closing.accepted ? "accepted" : "refused",
                              {{"pairs", static_cast<double>(pairs.size())},
                               {"dropped", closing.dropped},
                               {"merged", static_cast<double>(closing.merged.size())},
                               {"cost", closing.cost},
                               {"dof", closing.dof},
                               {"limit", closing.limit},
                               {"driven_m", life_.path_m() - search_->begun_path_m()},
                               {"moved_m", (filter_.pose().mean.position_m() - before.position_m()).norm()}}});
  if (closing.accepted) {
    drive_->close(closing.merged, closing.cost);
    std::vector<LandmarkId> recognised;
    for (const core::MergedLandmarks& one : closing.merged) recognised.push_back(one.kept);
    doubts_->close(life_.path_m(), recognised);
    end_search();
    smooth(report);
  } else {
    search_->refuse(life_.path_m());
  }
}

void Navigator::smooth(StepReport& report) {
  if (options_.search.closing == ClosingMethod::restart) drive_->let_go();  // no log says what was thrown away
  if (drive_->empty()) return;
  const core::Pose2 before = filter_.pose().mean;
  const Smoothing smoothing = smooth_drive(filter_, *drive_);
  if (smoothing.accepted) drive_->settle(smoothing.chi2);
  report.decisions.push_back({"smoothing",
                              smoothing.accepted ? "accepted" : "refused",
                              {{"chi2", smoothing.chi2},
                               {"limit", smoothing.limit},
                               {"poses", smoothing.poses},
                               {"iterations", smoothing.iterations},
                               {"moved_m", (filter_.pose().mean.position_m() - before.position_m()).norm()}}});
}

}  // namespace helixnav::supervisor
