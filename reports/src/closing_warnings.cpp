// SPDX-License-Identifier: BSD-3-Clause
#include "closing_warnings.hpp"

#include <variant>

#include "helixnav/core/decision.hpp"
#include "helixnav/core/time.hpp"
#include "helixnav/reports/decision_sentence.hpp"
#include "helixnav/runs/only_localized.hpp"

namespace helixnav::reports {
namespace {

struct Closings {
  int accepted = 0, refused = 0, undecided = 0;
  int cuts = 0;
  double cut_s = 0.0, cut_by_m = 0.0;  ///< the farthest of them
  int refused_since = 0;               ///< the last that was accepted
  bool is_path_solved = true;          ///< after the last that was accepted
};

/// Odometry and map were so far apart that no noise of the odometry reconciled them.
bool is_cut(const core::WholeMapDecision& asked) {
  return asked.verdict == core::WholeMapDecision::Verdict::accepted && asked.odometry_factor == 0.0;
}

Closings closings_of(const runs::Run& run) {
  Closings closings;
  for (const core::StepReport& step : run.steps) {
    for (const core::Decision& decision : step.decisions) {
      if (const auto* closure = std::get_if<core::ClosureDecision>(&decision)) {
        ++(closure->accepted ? closings.accepted : closings.refused);
        closings.refused_since = closure->accepted ? 0 : closings.refused_since + 1;
      }
      const auto* asked = std::get_if<core::WholeMapDecision>(&decision);
      if (asked != nullptr && is_cut(*asked)) {
        ++closings.cuts;
        if (asked->displaced_m > closings.cut_by_m) {
          closings.cut_by_m = asked->displaced_m;
          closings.cut_s = core::seconds(step.t_ns);
        }
      }
      closings.undecided += std::holds_alternative<core::UndecidedDecision>(decision);
      if (const auto* solved = std::get_if<core::SmoothingDecision>(&decision)) {
        closings.is_path_solved = solved->accepted;
      }
      const auto* systematic = std::get_if<core::SystematicDecision>(&decision);
      closings.is_path_solved |= systematic != nullptr && systematic->solved_again == 1;
    }
  }
  return closings;
}

const char* const typical_causes =
    "Typical causes are wheel slip, assumed noise that is too small, and lasting errors of the detector (a trunk's "
    "near "
    "side taken for its centre); 'helixnav calibrate' estimates the noise from the log";

/// The given map stays as it is, whatever is refused.
std::string refused_while_localizing_text(const Closings& closings) {
  return "places that the landmarks show were refused " + std::to_string(closings.refused) + " times (" +
         counted(closings.accepted, "time") +
         " accepted; searches that ended undecided: " + std::to_string(closings.undecided) +
         "): what was seen there differs from the map by more than the covariances allow. The map is bent by more than "
         "it says, or the vehicle was elsewhere meanwhile. The map itself is unchanged";
}

/// Of 193 drives of a tester, the seven like that had a mean NEES of 4 to 14.
std::string often_refused_text(const Closings& closings) {
  constexpr int often = 5;
  if (closings.refused < often || closings.refused <= 2 * closings.accepted) return {};
  return "closings were refused " + std::to_string(closings.refused) + " times, " + std::to_string(closings.accepted) +
         " were accepted: what was mapped at the returns differs from the map by more than the covariances allow. They "
         "are too small there, and landmarks may be in the map twice. " +
         typical_causes;
}

}  // namespace

std::vector<std::string> closing_warnings(const runs::Run& run) {
  const Closings closings = closings_of(run);
  std::vector<std::string> warnings;
  constexpr int several = 3;
  const bool is_mostly_refused = closings.refused_since >= several && closings.refused > 2 * closings.accepted;
  const bool is_mostly_undecided = closings.undecided >= 2 && closings.undecided > closings.accepted;
  const std::string often = often_refused_text(closings);
  if (runs::only_localized(run)) {
    if (is_mostly_refused || is_mostly_undecided || !often.empty())
      warnings.push_back(refused_while_localizing_text(closings));
  } else if (is_mostly_refused || is_mostly_undecided) {
    warnings.push_back("returns to old ground were left open (" + counted(closings.accepted, "closing") +
                       " accepted, " + std::to_string(closings.refused) +
                       " refused; searches that ended undecided: " + std::to_string(closings.undecided) +
                       "): landmarks there may be in the map twice, and the path keeps the drift until then. " +
                       typical_causes);
  } else if (!often.empty()) {
    warnings.push_back(often);
  }
  if (closings.cuts > 0) {
    warnings.push_back("odometry and the map were up to " + short_number(closings.cut_by_m) + " m apart at a return (" +
                       short_number(closings.cut_s) + " s; " + counted(closings.cuts, "time") +
                       "), more than any noise of odometry explains: the drive was cut there, as if the vehicle had "
                       "been carried. If it neither "
                       "slipped nor was carried, what was mapped before is bent by as much, whatever its covariance "
                       "says: sensors that "
                       "disagree in mounting or delay, a steering or gyro offset that changes, or landmarks that moved "
                       "together; 'helixnav "
                       "calibrate' estimates the first two");
  }
  if (!closings.is_path_solved) {
    warnings.emplace_back(
        "after the last closing the drive could not be solved as a whole: trajectory_final.tum is the path from before "
        "it; 'helixnav explain --closure N' has the numbers");
  }
  return warnings;
}

}  // namespace helixnav::reports
