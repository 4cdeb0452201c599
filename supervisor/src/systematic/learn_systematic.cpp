// SPDX-License-Identifier: BSD-3-Clause
// Learning by how much odometry and detections err throughout, and solving the drive again without it.
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "closing/tied_by_view.hpp"
#include "helixnav/core/errors.hpp"
#include "loop/navigation_loop.hpp"
#include "systematic/closing_evidence.hpp"
#include "systematic/spaced_out.hpp"
#include "systematic/stretch_evidence.hpp"

namespace helixnav::supervisor {
namespace {

constexpr int stops_a_stretch = 20;  // of one reach: more of them tell little more

/// Where something other than odometry and detections changed the drive or the names on the map.
bool interrupts(const Tape::Entry& entry) {
  const auto* scan = std::get_if<Tape::Scan>(&entry);
  return std::holds_alternative<Tape::Slip>(entry) || std::holds_alternative<Tape::Merge>(entry) ||
         std::holds_alternative<Tape::Solved>(entry) || (scan != nullptr && scan->slipped);
}

/// The first such entry between two positions, or the second position.
Tape::Position first_interruption(const Tape& tape, Tape::Position from, Tape::Position until) {
  Tape::Position position = from, found = until;
  tape.read_between(from, until, [&](const Tape::Entry& entry) {
    if (found == until && interrupts(entry)) found = position;
    ++position;
  });
  return found;
}

/// Whether odometry was silent for a part of that time that matters.
bool is_silent(const Tape& tape, Tape::Position begun, Tape::Position until) {
  constexpr double little = 0.1;
  TimeMoved time;
  tape.read_between(begun, until, [&](const Tape::Entry& entry) {
    if (const auto* motion = std::get_if<Tape::Motion>(&entry)) time += motion->time;
  });
  return time.silent_s > little * time.seconds;
}

/// Of what the tape holds between two positions, if that determines anything.
std::optional<StretchEvidence> evidence_between(const Tape& tape, Tape::Position begun, Tape::Position until,
                                                double reach_m) {
  constexpr std::size_t least_stops = 5;
  if (is_silent(tape, begun, until)) return std::nullopt;
  const std::vector<Stop> stops = spaced_out(stops_between(tape, begun, until), reach_m / stops_a_stretch);
  if (stops.size() < least_stops) return std::nullopt;
  try {
    return evidence_of_stretch(stops);
  } catch (const core::NumericalError&) {
    return std::nullopt;
  }
}

std::optional<StretchEvidence> evidence_if_solvable(const Tape& tape, const std::vector<core::StampedPose>& path,
                                                    double reach_m) {
  try {
    return evidence_of_closing(tape, path, reach_m);
  } catch (const core::NumericalError&) {
    return std::nullopt;
  }
}

}  // namespace

/// While mapping, with nothing in question. A stretch is one reach of the sensor long, or ends where it is interrupted.
void NavigationLoop::learn_systematic(core::StepReport& report) {
  SystematicState& systematic = noise_.systematic;
  const std::optional<double> reach_m = view_.reach();
  if (!options_.noise.systematic || !reach_m || searching() != nullptr) {
    systematic.begun.reset();
    return;
  }
  learn_from_closing(report);
  const double path_m = belief_.existence.path_m();
  const Tape::Position end = tape_.end();
  const bool is_on_tape = systematic.begun && tape_.holds_since(*systematic.begun) && systematic.read <= end;
  if (!is_on_tape || *systematic.begun > systematic.read) systematic.begin(end, path_m);
  const Tape::Position until = first_interruption(tape_, std::exchange(systematic.read, end), end);
  if (until == end && path_m - systematic.begun_m < *reach_m) return;
  const auto evidence = evidence_between(tape_, *systematic.begun, until, *reach_m);
  if (evidence) systematic.learner.add(*evidence);
  if (evidence) take_out_systematic(report);
  systematic.begin(tape_.end(), path_m);
}

/// A closing to which odometry had to give way by more than its noise. What it says is told with the noise as it was measured, although
/// the drive may have been closed with more.
void NavigationLoop::learn_from_closing(core::StepReport& report) {
  constexpr double three_sigmas = 9.0;  // of χ²
  const OddClosing odd = std::exchange(pending_.odd_closing, {});
  if (report.merged.empty() || !(odd.excess > three_sigmas)) return;
  SystematicState& systematic = noise_.systematic;
  systematic.odd = odd;
  systematic.odd.path_m = belief_.existence.path_m();
  if (odd.odometry_factor < 1.0 || !tape_.holds_drive() || is_silent(tape_, tape_.begin(), tape_.end())) return;
  const std::optional<StretchEvidence> evidence = evidence_if_solvable(as_measured(), report.solved, *view_.reach());
  if (!evidence) return;
  systematic.learner.add_closing(*evidence);
  const std::optional<CertainErrors> found = systematic.learner.certain_after_closing();
  if (!found || !solve_without(found->errors, report)) return;
  systematic.learner.take_out(found->errors);
  report_systematic(found->nats, report);
  merge_what_straightened(report);
}

/// Copies that odometry with the errors had left beside their landmarks.
void NavigationLoop::merge_what_straightened(core::StepReport& report) {
  merge_left_open(view_, tied_since_m(tape_, belief_.existence.path_m(), options_.search.old_after_m), report);
  merge_mapped_twice(report);
  trust(take_checkpoint(belief_, tape_));
}

/// The tape, had odometry not been allowed more noise for the last closing that it did not fit.
Tape NavigationLoop::as_measured() const {
  const OddClosing& odd = noise_.systematic.odd;
  const double ago_m = belief_.existence.path_m() - odd.path_m;
  return tape_.without_last_solution().with_larger_noise(1.0 / odd.odometry_factor, odd.loop_m, ago_m);
}

/// Without the errors odometry may fit that closing as it was measured.
bool NavigationLoop::solve_without(const SystematicErrors& errors, core::StepReport& report) {
  OddClosing& odd = noise_.systematic.odd;
  if (odd.odometry_factor > 1.0 && tape_.holds_drive() && solve_again(as_measured().without(errors), report)) {
    odd = {};
    return true;
  }
  return solve_again(tape_.without(errors), report);
}

/// Of the whole drive, or, on an earlier map and once the atlas holds a part of the drive, of what has not been taken into it: its
/// phases do not say which of their measurements err. Where that is not known either, from now on.
void NavigationLoop::take_out_systematic(core::StepReport& report) {
  SystematicLearner& learner = noise_.systematic.learner;
  const std::optional<CertainErrors> back = learner.contradicted();
  const std::optional<CertainErrors> found = back ? back : learner.certain();
  if (!found) return;
  if (is_drive_known() && !solve_without(found->errors, report)) return;
  back ? learner.give_up(found->errors) : learner.take_out(found->errors);
  report_systematic(found->nats, report);
}

void NavigationLoop::report_systematic(double nats, core::StepReport& report) const {
  const SystematicLearner& learner = noise_.systematic.learner;
  const SystematicErrors& all = learner.taken_out();
  report.decisions.emplace_back(core::SystematicDecision{all.too_long, all.turn_rad_per_s, all.turn_rad_per_m,
                                                         all.heading_rad, all.short_m, nats, learner.stretches(),
                                                         tape_.holds_drive() ? 1 : 0});
}

}  // namespace helixnav::supervisor
