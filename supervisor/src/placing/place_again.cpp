// SPDX-License-Identifier: BSD-3-Clause
// A place that was found on another map is contradicted by what was mapped since: the part is driven again from before it was
// placed, and is placed elsewhere, or everything stays as it is.
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "loop/navigation_loop.hpp"
#include "loop/process_again.hpp"
#include "placing/placing_record.hpp"

namespace helixnav::supervisor {
namespace {

using core::PlacedDecision;
using core::StepReport;

PlacedDecision* placing_in(StepReport& report) {
  for (core::Decision& decision : report.decisions) {
    auto* placed = std::get_if<PlacedDecision>(&decision);
    if (placed != nullptr && placed->verdict == PlacedDecision::Verdict::accepted) return placed;
  }
  return nullptr;
}

/// A landmark of another map was begun before this drive.
bool is_of_other_map(const association::LandmarkRecord& record) { return record.born_path_m < 0.0; }

}  // namespace

/// The whole map has the place of these landmarks where no measured motion leads. A wrong place contradicts what is mapped later as a
/// vehicle does that was carried without a pause, and as long as it may be wrong, that is not believed.
void NavigationLoop::look_elsewhere(const core::Scan& scan, StepReport& report) {
  const std::vector<pf_relocalize::ConstellationPair> pairs = std::exchange(pending_.forbidden, {});
  if (part_at_pause(pairs, scan, report)) return;
  if (!may_be_placed_wrongly(pairs)) {
    part_at_gap(pairs, scan, report);
  } else if (belief_.step >= questions_.place_again_at) {
    place_again(scan, report);
  }
}

/// Once the tape would have to keep too much.
void NavigationLoop::forget_old_placing() noexcept {
  if (!apart_.placing) return;
  const std::int64_t scans = belief_.step - apart_.placing->belief.step;
  const bool is_taken_in = belief_.drive && belief_.drive->end() > apart_.placing->since;
  if (scans <= options_.search.smooth_up_to_scans && !is_taken_in) return;
  apart_.placing.reset();
  tape_.keep_since(std::nullopt);
}

/// The map that the part was placed on.
const PlaceSearch* NavigationLoop::search_of_placing() const {
  for (const MapApart& map : apart_.placing->apart.maps) {
    if (map.part == apart_.part) return map.search.get();
  }
  return nullptr;
}

/// By landmarks on another map that are elsewhere than where it was placed, while few of what was seen since are of that map. Once
/// as many of it were recognised since as two places need, ground that it does not cover says nothing: a vehicle that was placed rightly,
/// left that map and was carried then is no sign of a wrong place.
bool NavigationLoop::may_be_placed_wrongly(const std::vector<pf_relocalize::ConstellationPair>& pairs) const {
  if (!apart_.placing || apart_.any()) return false;
  const association::LandmarkLife& existence = belief_.existence;
  const auto is_on_other_map = [&](const pf_relocalize::ConstellationPair& pair) {
    return existence.contains(pair.old_landmark) && is_of_other_map(existence.record(pair.old_landmark));
  };
  if (!std::all_of(pairs.begin(), pairs.end(), is_on_other_map)) return false;
  const PlaceSearch* other_map = search_of_placing();
  const auto is_on_its_ground = [&](core::LandmarkId id) {
    return other_map != nullptr && belief_.filter.contains(id) && other_map->covers(belief_.filter.landmark_mean(id));
  };
  const double soon_m = apart_.placing->path_m + view_.reach().value_or(0.0);
  int off_its_ground = 0, on_its_ground = 0, of_other_map = 0;
  for (const association::LandmarkRecord& record : existence.records()) {
    if (record.last_seen_path_m <= soon_m) continue;
    if (is_of_other_map(record)) {
      ++of_other_map;
    } else {
      ++(is_on_its_ground(record.id) ? on_its_ground : off_its_ground);
    }
  }
  const bool is_confirmed = of_other_map >= 2 * options_.search.constellation.least_matches;
  const int others = on_its_ground + (is_confirmed ? 0 : off_its_ground);
  constexpr int few = 2;  // of the map, at most one in three
  return few * of_other_map <= others;
}

/// As it was before it was placed.
NavigationLoop::Part NavigationLoop::part_before_placing() const {
  const PlacingRecord& record = *apart_.placing;
  core::CarriedDecision decision;
  decision.cause = core::CarriedDecision::Cause::wrong_place;
  decision.scans = static_cast<int>(belief_.step - 1 - apart_.begun_step);
  Part part = part_apart(decision, {}, record.belief);
  const int number = part.apart.part;
  part.start = record.start;
  part.tape = record.tape;
  part.belief.filter.name_from(std::max(belief_.filter.next_name(), record.belief.filter.next_name()));
  part.mode = Mapping{{}, take_checkpoint(part.belief, part.tape), {}};
  part.apart = record.apart;
  part.apart.part = number;
  part.apart.next_part = number + 1;
  part.apart.begun_step = apart_.begun_step;
  part.apart.asked.questions += questions_.asked.questions;
  return part;
}

/// Landmarks that were then and are not now: merged, most of them.
std::vector<core::LandmarkId> NavigationLoop::gone_since_placing() const {
  std::vector<core::LandmarkId> gone;
  for (const association::LandmarkRecord& record : apart_.placing->belief.existence.records()) {
    if (!belief_.existence.contains(record.id)) gone.push_back(record.id);
  }
  return gone;
}

/// What came in since; the last entry is the present scan.
void NavigationLoop::drive_again(const std::vector<Tape::Entry>& since, StepReport& report) {
  process_again(
      since, [](const Tape::Fix&, bool) {},
      [&](StepReport again) {
        report.merged.insert(report.merged.end(), again.merged.begin(), again.merged.end());
        report.revised.push_back({again.step, again.associations});
        report.numerics.note(again.numerics);
        report.associations = std::move(again.associations);
        if (std::get_if<Mapping>(&mode_) != nullptr) trust(take_checkpoint(belief_, tape_));
        belief_.filter.keep_since(checkpoint().filter.phase);
      });
  report.revised.pop_back();  // the last one is this scan
  report.pose = pose();
}

/// Only if it is then found elsewhere, by more than it was placed with.
void NavigationLoop::place_again(const core::Scan& scan, StepReport& report) {
  const std::shared_ptr<const PlacingRecord> record = apart_.placing;
  std::vector<Tape::Entry> since;
  tape_.read_from(record->since, [&](const Tape::Entry& entry) { since.push_back(entry); });
  if (since.empty()) return;
  const core::Pose2 believed = belief_.filter.pose().mean;
  const std::vector<core::LandmarkId> gone = gone_since_placing();
  constexpr std::int64_t share = 4;  // what is driven again altogether is no more than five times the drive
  questions_.place_again_at = belief_.step + (belief_.step - record->belief.step) / share;
  StepReport placed = report;
  Part part = part_before_placing();
  exchange(part);
  Undo before = std::exchange(undo_, Undo{{}, tape_.end(), searches_, {}, {}, {}, {}, {}});
  const std::uint64_t searches = searches_;
  const auto give_up = [&] {
    exchange(part);
    undo_ = std::move(before);
    searches_ = searches;
  };
  try {
    report_late(placed);
    for (const core::LandmarkId id : gone) placed.merged.push_back({id, id});  // it exists again
    drive_again(since, placed);
    find_place(scan.field_of_view, placed);
  } catch (const core::NumericalError&) {
    give_up();
    ++pending_.numerics.refused;
    return;
  } catch (...) {
    give_up();
    throw;
  }
  PlacedDecision* found = placing_in(placed);
  const double moved_m = (belief_.filter.pose().mean.position_m() - believed.position_m()).norm();
  const bool is_better = found != nullptr && !apart_.any() && std::min(found->evidence, found->lead) > record->evidence;
  if (!is_better || moved_m < options_.search.rivals.distinct_m) {
    give_up();
    return;
  }
  found->T_map_session = core::compose(found->T_map_session, core::inverse(record->T_map_part));
  report = std::move(placed);
}

}  // namespace helixnav::supervisor
