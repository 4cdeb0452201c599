// SPDX-License-Identifier: BSD-3-Clause
// The vehicle was carried and nobody noticed: the landmarks mapped since are found elsewhere on the map, where no measured motion leads.
// They become a separate part of the drive, as if it had been noticed. A pause tells when it was, or else the landmarks do.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "loop/navigation_loop.hpp"
#include "placing/gap_in_sightings.hpp"

namespace helixnav::supervisor {
namespace {

using core::StepReport;

constexpr int few = 3;  // matches with what was seen before are chance: at most one in three

/// Of a closing or of a search in an earlier map.
bool has_certain_place(const StepReport& report) {
  return std::any_of(report.decisions.begin(), report.decisions.end(), [](const core::Decision& decision) {
    const auto* closure = std::get_if<core::ClosureDecision>(&decision);
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    return (closure != nullptr && closure->accepted) ||
           (placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted);
  });
}

/// What was seen at a length of the drive was seen after this one.
double just_before(double path_m) { return std::nextafter(path_m, -std::numeric_limits<double>::infinity()); }

double first_born_after(double path_m, const association::LandmarkLife& existence) {
  double first_m = existence.path_m();
  for (const association::LandmarkRecord& record : existence.records()) {
    if (record.born_path_m > path_m) first_m = std::min(first_m, record.born_path_m);
  }
  return first_m;
}

/// Lengths of the drive when the first paired landmark of the branch and the last paired old one were begun.
struct PairsBorn {
  double first_m = 0.0;
  double last_old_m = 0.0;
};

std::optional<PairsBorn> when_born(const std::vector<pf_relocalize::ConstellationPair>& pairs,
                                   const association::LandmarkLife& existence) {
  PairsBorn born{existence.path_m(), 0.0};
  for (const pf_relocalize::ConstellationPair& pair : pairs) {
    if (!existence.contains(pair.branch) || !existence.contains(pair.old_landmark)) return std::nullopt;
    born.first_m = std::min(born.first_m, existence.record(pair.branch).born_path_m);
    born.last_old_m = std::max(born.last_old_m, existence.record(pair.old_landmark).born_path_m);
  }
  return born;
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
  const std::optional<PairsBorn> born = when_born(pairs, existence);
  if (!born) return std::nullopt;
  const auto after =
      std::find_if(pauses_.begin(), pauses_.end(), [&](const UnsurePause& p) { return p.path_m >= born->first_m; });
  if (after == pauses_.begin()) return std::nullopt;
  const UnsurePause pause = *std::prev(after);
  if (born->last_old_m > pauses_.front().path_m) return std::nullopt;
  int since = 0, across = 0;
  for (const association::LandmarkRecord& record : existence.records()) {
    if (record.last_seen_path_m <= pause.path_m) continue;
    ++since;
    across += record.born_path_m <= pause.path_m;
  }
  const bool is_recent = existence.path_m() - pause.path_m <= options_.search.undecided_m;
  return few * across <= since && (is_recent || across == 0) ? std::optional(pause) : std::nullopt;
}

/// Likewise where no pause tells: where everything vanished, or else where the landmarks seen before are seen no longer.
std::optional<SightingGap> NavigationLoop::gap_before(
    const std::vector<pf_relocalize::ConstellationPair>& pairs) const {
  const association::LandmarkLife& existence = belief_.existence;
  const std::optional<PairsBorn> born = when_born(pairs, existence);
  if (!is_monitored() || !born) return std::nullopt;
  if (const std::optional<double>& since_m = belief_.untied_since_m) {
    const double after_m = first_born_after(*since_m, existence);
    return born->last_old_m <= *since_m ? std::optional(SightingGap{after_m, after_m, 0, 0}) : std::nullopt;
  }
  const std::optional<SightingGap> gap = gap_in_sightings(existence, born->last_old_m, born->first_m);
  if (!gap) return std::nullopt;
  const bool is_recent = existence.path_m() - gap->first_m <= options_.search.undecided_m;
  return few * gap->across <= gap->since && (is_recent || gap->across == 0) ? gap : std::nullopt;
}

/// Number of the first scan taken after this length of the drive, as far back as the tape has it.
std::int64_t NavigationLoop::step_after(double path_m) const {
  double driven_m = 0.0;
  std::vector<double> scans_at_m;
  tape_.read_from(0, [&](const Tape::Entry& entry) {
    if (const auto* motion = std::get_if<Tape::Motion>(&entry)) driven_m += motion->driven_m;
    if (std::holds_alternative<Tape::Scan>(entry)) scans_at_m.push_back(driven_m);
  });
  const double begun_m = belief_.existence.path_m() - driven_m;
  constexpr double rounding_m = 1e-6;
  const auto is_after = [&](double at_m) { return begun_m + at_m > path_m - rounding_m; };
  return belief_.step - std::count_if(scans_at_m.begin(), scans_at_m.end(), is_after);
}

/// Pose and landmarks begun since, in the frame they are in.
Belief NavigationLoop::belief_since(double path_m) const {
  std::vector<core::LandmarkId> ids;
  association::LandmarkLife existence = belief_.existence;
  for (const association::LandmarkRecord& record : belief_.existence.records()) {
    if (record.born_path_m <= path_m) {
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
  belief.coverage.begin_after(path_m);
  return belief;
}

bool NavigationLoop::part_at_pause(const std::vector<pf_relocalize::ConstellationPair>& pairs, const core::Scan& scan,
                                   StepReport& report) {
  const std::optional<UnsurePause> pause = pause_before(pairs);
  return pause && part_between(pauses_.front().path_m, *pause, scan, report);
}

bool NavigationLoop::part_at_gap(const std::vector<pf_relocalize::ConstellationPair>& pairs, const core::Scan& scan,
                                 StepReport& report) {
  const std::optional<SightingGap> gap = gap_before(pairs);
  if (!gap) return false;
  const double last_m = just_before(gap->last_m);
  return part_between(just_before(gap->first_m), {last_m, step_after(last_m)}, scan, report);
}

/// Of a large map the filter holds what is around where the vehicle was: the rest is asked as a map of its own. A place that is not
/// found counts as a question.
bool NavigationLoop::part_since_untied(const core::Scan& scan, StepReport& report) {
  if (!belief_.untied_since_m || !is_drive_known()) return false;
  const double last_m = just_before(first_born_after(*belief_.untied_since_m, belief_.existence));
  if (part_between(last_m, {last_m, step_after(last_m)}, scan, report)) return true;
  ++apart_.asked.questions;
  return false;
}

/// Only if the part is then found on the map from before: otherwise everything stays as it is. If the vehicle may have been carried at
/// several places since its own was certain, nobody knows which one it was: what was mapped between them is dropped, and so
/// is what was matched since.
bool NavigationLoop::part_between(double map_until_m, const UnsurePause& pause, const core::Scan& scan,
                                  StepReport& report) {
  if (apart_.any()) return false;
  core::CarriedDecision decision;
  decision.cause = core::CarriedDecision::Cause::by_place;
  decision.scans = static_cast<int>(report.step - pause.step);
  core::JointMap map = map_to_keep(decision, map_until_m);
  if (map.joint.ids.empty()) return false;
  Part other = part_apart(decision, std::move(map), belief_since(pause.path_m));
  other.tape.drop_drive();  // of how its landmarks were mapped it has nothing
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
