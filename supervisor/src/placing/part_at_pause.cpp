// SPDX-License-Identifier: BSD-3-Clause
// The vehicle was carried during a pause and nobody noticed: the landmarks mapped since are found elsewhere on the map,
// where no measured motion leads. They become a separate part of the drive, as if it had been noticed.
#include <algorithm>
#include <utility>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "loop/navigation_loop.hpp"

namespace helixnav::supervisor {
namespace {

using core::StepReport;

/// Of a closing or of a search in an earlier map.
bool has_certain_place(const StepReport& report) {
  return std::any_of(report.decisions.begin(), report.decisions.end(), [](const core::Decision& decision) {
    const auto* closure = std::get_if<core::ClosureDecision>(&decision);
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    return (closure != nullptr && closure->accepted) ||
           (placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted);
  });
}

}  // namespace

/// The pauses before the vehicle knew where it is.
void NavigationLoop::forget_pauses(const StepReport& report) {
  if (has_certain_place(report)) pauses_.clear();
}

/// The last pause before the paired branch landmarks were mapped, if the vehicle can have been carried then: the old
/// landmarks were mapped before it, and few other earlier ones were matched since: none, or it is no longer ago than a search may last.
std::optional<UnsurePause> NavigationLoop::pause_before(
    const std::vector<pf_relocalize::ConstellationPair>& pairs) const {
  const association::LandmarkLife& existence = belief_.existence;
  double first_m = existence.path_m();
  double last_old_m = 0.0;
  for (const pf_relocalize::ConstellationPair& pair : pairs) {
    if (!existence.contains(pair.branch) || !existence.contains(pair.old_landmark)) return std::nullopt;
    first_m = std::min(first_m, existence.record(pair.branch).born_path_m);
    last_old_m = std::max(last_old_m, existence.record(pair.old_landmark).born_path_m);
  }
  const auto after =
      std::find_if(pauses_.begin(), pauses_.end(), [&](const UnsurePause& p) { return p.path_m >= first_m; });
  if (after == pauses_.begin()) return std::nullopt;
  const UnsurePause pause = *std::prev(after);
  if (last_old_m > pauses_.front().path_m) return std::nullopt;
  int since = 0, across = 0;
  for (const association::LandmarkRecord& record : existence.records()) {
    if (record.last_seen_path_m <= pause.path_m) continue;
    ++since;
    across += record.born_path_m <= pause.path_m;
  }
  constexpr int few = 3;  // at most one in three
  const bool is_recent = existence.path_m() - pause.path_m <= options_.search.undecided_m;
  return few * across <= since && (is_recent || across == 0) ? std::optional(pause) : std::nullopt;
}

/// Pose and landmarks begun since, in the frame they are in.
Belief NavigationLoop::belief_since(const UnsurePause& pause) const {
  std::vector<core::LandmarkId> ids;
  association::LandmarkLife existence = belief_.existence;
  for (const association::LandmarkRecord& record : belief_.existence.records()) {
    if (record.born_path_m <= pause.path_m) {
      existence.remove(record.id);
    } else if (belief_.filter.contains(record.id)) {
      ids.push_back(record.id);
    }
  }
  Belief belief{cekf::CompressedEkf(belief_.filter.joint(ids), belief_.filter.next_name(), options_.filter),
                std::move(existence),
                belief_.coverage,
                {},
                belief_.step,
                belief_.slips};
  belief.moving = belief_.moving;
  belief.coverage.begin_after(pause.path_m);
  return belief;
}

/// Only if the part is then found on the map from before: otherwise everything stays as it is. If there were several
/// pauses since the place was certain, nobody knows which one it was: what was mapped between them is dropped, and so
/// is what was matched since.
bool NavigationLoop::part_at_pause(const std::vector<pf_relocalize::ConstellationPair>& pairs, const core::Scan& scan,
                                   StepReport& report) {
  const std::optional<UnsurePause> pause = pause_before(pairs);
  if (!pause || apart_.any()) return false;
  core::CarriedDecision decision;
  decision.cause = core::CarriedDecision::Cause::by_place;
  decision.scans = static_cast<int>(report.step - pause->step);
  core::JointMap map = map_to_keep(decision, pauses_.front().path_m);
  if (map.joint.ids.empty()) return false;
  Part other = part_apart(decision, std::move(map), belief_since(*pause));
  StepReport placed = report;
  exchange(other);
  try {
    report_late(placed);
    find_place(scan.field_of_view, placed);
  } catch (const core::NumericalError&) {
    exchange(other);
    ++pending_.numerics.refused;
    return false;
  } catch (...) {
    exchange(other);
    throw;
  }
  if (apart_.any()) {
    exchange(other);
    return false;
  }
  report = std::move(placed);
  return true;
}

}  // namespace helixnav::supervisor
