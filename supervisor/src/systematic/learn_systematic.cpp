// SPDX-License-Identifier: BSD-3-Clause
// Learning by how much odometry and detections err throughout, and solving the drive again without it.
#include <optional>
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
std::vector<Stop> thinned(const std::vector<Stop>& stops, double least_m) {
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

/// What the tape holds from a position on, if it is one piece and determines anything.
std::optional<StretchEvidence> evidence_since(const Tape& tape, Tape::Position begun, double stretch_m) {
  bool is_one_piece = true;
  tape.read_from(begun, [&](const Tape::Entry& entry) { is_one_piece = is_one_piece && !interrupts(entry); });
  if (!is_one_piece) return std::nullopt;
  try {
    return evidence_of_stretch(thinned(stops_of(tape, begun), stretch_m / stops_a_stretch));
  } catch (const core::NumericalError&) {
    return std::nullopt;
  }
}

}  // namespace

/// A stretch is one reach of the sensor long: while mapping, with nothing in question.
void NavigationLoop::learn_systematic(core::StepReport& report) {
  SystematicState& systematic = noise_.systematic;
  const std::optional<double> reach_m = view_.reach();
  if (!options_.noise.systematic || !reach_m || searching() != nullptr) {
    systematic.begun.reset();
    return;
  }
  const double path_m = belief_.existence.path_m();
  const bool goes_on = systematic.begun && *systematic.begun <= tape_.end() && tape_.holds_since(*systematic.begun);
  if (goes_on && path_m - systematic.begun_m < *reach_m) return;
  if (goes_on) {
    const auto evidence = evidence_since(tape_, *systematic.begun, *reach_m);
    if (evidence) systematic.learner.add(*evidence);
    if (evidence) take_out_systematic(report);
  }
  systematic.begin(tape_.end(), path_m);
}

/// Of the whole drive. Where an earlier map cannot be drawn again, only from here on. A drive of which the atlas holds a part stays
/// as it is.
void NavigationLoop::take_out_systematic(core::StepReport& report) {
  if (belief_.drive && !tape_.holds_drive()) return;
  SystematicLearner& learner = noise_.systematic.learner;
  const std::optional<CertainErrors> found = learner.certain();
  if (!found) return;
  if (tape_.holds_drive() && !solve_again(tape_.without(found->errors), report)) return;
  learner.take_out(found->errors);
  const SystematicErrors& all = learner.taken_out();
  report.decisions.emplace_back(core::SystematicDecision{all.too_long, all.turn_rad_per_s, all.turn_rad_per_m,
                                                         all.heading_rad, all.short_m, found->nats, learner.stretches(),
                                                         tape_.holds_drive()});
}

}  // namespace helixnav::supervisor
