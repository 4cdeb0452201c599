// SPDX-License-Identifier: BSD-3-Clause
// Everything that was in view has vanished from one scan to the next, and stayed away: the vehicle slipped, to a place that one scan
// does not show.
#include <optional>
#include <utility>
#include <vector>

#include "helixnav/supervisor/lengths.hpp"
#include "loop/navigation_loop.hpp"
#include "loop/process_again.hpp"
#include "slip/should_be_seen.hpp"
#include "slip/slip_evidence.hpp"
#include "slip/untied.hpp"

namespace helixnav::supervisor {
namespace {

/// Position in `entries`, which begin before scan `first`, of a later scan.
std::size_t position_of(std::int64_t step, std::int64_t first, const std::vector<Tape::Entry>& entries) {
  std::size_t at = 0;
  for (std::int64_t scan = first; at < entries.size(); ++at) {
    if (std::holds_alternative<Tape::Scan>(entries[at]) && scan++ == step) break;
  }
  return at;
}

}  // namespace

void NavigationLoop::note_seen_again(const core::Scan& scan, bool slipped, const core::StepReport& report) {
  const std::size_t sensor = belief_.seen_again.sensor_of(scan);
  if (slipped || !options_.slip.enabled || !is_monitored() || has_unplaced(scan)) {
    belief_.seen_again.start_from(sensor, report.associations);
    return;
  }
  const auto chance = [&](const std::vector<core::LandmarkId>& ids) {
    return chance_of_match(belief_.filter, scan, ids, options_.gates.match_probability);
  };
  belief_.seen_again.see(belief_.step, sensor, report.associations,
                         should_be_seen(belief_.filter, scan, options_.view_margin_m,
                                        belief_.seen_again.watched(sensor), report.associations),
                         belief_.existence, options_.extraneous_per_scan, belief_.slips.count, chance);
}

/// Before anything was trusted that came after the slip.
bool NavigationLoop::has_slipped_away() const {
  const Vanished* lost = belief_.seen_again.lost();
  return lost != nullptr && checkpoint().step <= lost->step;
}

/// For good: that the known ones become few among all that is seen later says nothing.
void NavigationLoop::forget_if_tied_again() {
  const std::optional<double>& since_m = belief_.untied_since_m;
  if (since_m && is_tied_again(belief_.existence, *since_m)) belief_.untied_since_m.reset();
}

/// As it is reported. Nothing here reads it: the filter assumes that the vehicle slipped, and stays exact for what is mapped since.
core::PoseGaussian NavigationLoop::pose() const {
  if (!belief_.untied_since_m) return belief_.filter.pose();
  return pose_anywhere(belief_.filter, belief_.existence, *belief_.untied_since_m,
                       view_.reach().value_or(reference_reach_m));
}

/// What was mapped in a search that odometry tied to the map may be copies.
void NavigationLoop::leave_search() {
  const Searching* open = searching();
  if (open == nullptr || open->after_slip) return;
  belief_.left_open.push_back({open->search.begun_path_m(), belief_.existence.path_m()});
}

/// What nothing ties to the map: the vehicle has left that, too, and nothing will tell where it is. On the map it would be where it never
/// was, and later be merged with what stands there.
void NavigationLoop::drop_untied() {
  if (!belief_.untied_since_m) return;
  const std::vector<association::LandmarkRecord> records = belief_.existence.records();
  for (const association::LandmarkRecord& record : records) {
    if (record.born_path_m <= *belief_.untied_since_m) continue;
    belief_.existence.remove(record.id);
    if (belief_.filter.contains(record.id)) belief_.filter.remove(record.id);
  }
}

/// Where places repeat, or too few landmarks are in view, a slip has rivals and is not believed. But the vehicle is not where
/// odometry puts it, either: its pose becomes as uncertain as the largest slips are, before the scan after the slip, and a
/// search decides where it is.
core::StepReport NavigationLoop::search_since_slip(core::StepReport report) {
  const Vanished lost = *belief_.seen_again.lost();
  const Checkpoint trusted = checkpoint();
  const core::LandmarkId next = belief_.filter.next_name();
  const SlipComponent largest = slip_components(options_.slip).back();
  const std::vector<Tape::Entry>& since = undo_.rolled_back.emplace(tape_.cut(trusted.position));
  const auto slip = since.begin() + static_cast<std::ptrdiff_t>(position_of(lost.step, trusted.step, since));
  roll_back(trusted, belief_);
  if (Searching* open = searching()) open->is_over = true;
  process_again(
      {since.begin(), slip}, [](const Tape::Fix&, bool) {}, [](const core::StepReport&) {});
  leave_search();
  drop_untied();
  belief_.untied_since_m = belief_.existence.path_m();
  belief_.seen_again.forget();
  predict();
  pending_.decisions = std::move(report.decisions);
  pending_.decisions.emplace_back(core::LostBySlipDecision{static_cast<int>(lost.missing.size()), lost.seen,
                                                           static_cast<int>(lost.unknown.size()), lost.nats,
                                                           largest.sigma_m});
  const core::Scan& scan = std::get<Tape::Scan>(*slip).scan;
  move_unmeasured(largest.covariance(), scan.t_ns);
  belief_.filter.name_from(next);
  begin_search(scan);
  searching()->after_slip = true;
  return process_in_search({slip, since.end()}, std::move(report));
}

}  // namespace helixnav::supervisor
