// SPDX-License-Identifier: BSD-3-Clause
// Learning by how much odometry and detections err throughout, and solving the drive again without it.
#include <cstddef>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"
#include "loop/navigation_loop.hpp"
#include "systematic/stretch_evidence.hpp"

namespace helixnav::supervisor {
namespace {

constexpr int stops_a_stretch = 20;  // of one reach: more of them tell little more

/// Scans closer than that to the one before are passed over.
std::vector<Stop> spaced_out(const std::vector<Stop>& stops, double least_m) {
  std::vector<Stop> chosen;
  std::optional<core::Odometry> motion;
  for (const Stop& stop : stops) {
    if (stop.motion) motion = motion ? core::chain(*motion, *stop.motion) : *stop.motion;
    const bool is_far = motion && motion->T_before_after.position_m().norm() >= least_m;
    if (!chosen.empty() && !is_far) continue;
    chosen.push_back(stop);
    chosen.back().motion = chosen.size() > 1 ? motion : std::nullopt;
    motion.reset();
  }
  return chosen;
}

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

}  // namespace

/// While mapping, with nothing in question. A stretch is one reach of the sensor long, or ends where it is interrupted.
void NavigationLoop::learn_systematic(core::StepReport& report) {
  SystematicState& systematic = noise_.systematic;
  const std::optional<double> reach_m = view_.reach();
  if (!options_.noise.systematic || !reach_m || searching() != nullptr) {
    systematic.begun.reset();
    return;
  }
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

/// Of the whole drive, or, on an earlier map and once the atlas holds a part of the drive, of what has not been taken into it: its
/// phases do not say which of their measurements err. Where that is not known either, from now on.
void NavigationLoop::take_out_systematic(core::StepReport& report) {
  SystematicLearner& learner = noise_.systematic.learner;
  const std::optional<CertainErrors> back = learner.contradicted();
  const std::optional<CertainErrors> found = back ? back : learner.certain();
  if (!found) return;
  const bool is_whole = tape_.holds_drive();
  if (is_drive_known() && !solve_again(tape_.without(found->errors), report)) return;
  back ? learner.give_up(found->errors) : learner.take_out(found->errors);
  const SystematicErrors& all = learner.taken_out();
  report.decisions.emplace_back(core::SystematicDecision{all.too_long, all.turn_rad_per_s, all.turn_rad_per_m,
                                                         all.heading_rad, all.short_m, found->nats, learner.stretches(),
                                                         is_whole ? 1 : 0});
}

}  // namespace helixnav::supervisor
