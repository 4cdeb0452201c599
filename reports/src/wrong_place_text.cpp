// SPDX-License-Identifier: BSD-3-Clause
#include "wrong_place_text.hpp"

#include <algorithm>
#include <variant>

#include "helixnav/reports/decision_sentence.hpp"
#include "helixnav/reports/run_warnings.hpp"

namespace helixnav::reports {
namespace {

const core::PlacedDecision* placing_in(const core::StepReport& step) {
  for (const core::Decision& decision : step.decisions) {
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    if (placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted) return placed;
  }
  return nullptr;
}

/// From the pose that the step would have had to the one it has.
double moved_m(const core::StepReport& step, const core::PlacedDecision& placed) {
  const core::Pose2 believed = core::compose(core::inverse(placed.T_map_session), step.pose.mean);
  return (step.pose.mean.position_m() - believed.position_m()).norm();
}

}  // namespace

bool is_wrong_place(const core::Decision& decision) {
  const auto* carried = std::get_if<core::CarriedDecision>(&decision);
  return carried != nullptr && carried->cause == core::CarriedDecision::Cause::wrong_place;
}

bool is_wrong_start(const core::Decision& decision) {
  const auto* carried = std::get_if<core::CarriedDecision>(&decision);
  return carried != nullptr && carried->cause == core::CarriedDecision::Cause::wrong_start;
}

bool is_carried_off(const core::Decision& decision) {
  return std::holds_alternative<core::CarriedDecision>(decision) && !is_wrong_place(decision) &&
         !is_wrong_start(decision);
}

std::string wrong_place_text(const runs::Run& run) {
  std::string text;
  const core::StepReport* placed_at = nullptr;
  for (const core::StepReport& step : run.steps) {
    const core::PlacedDecision* placed = placing_in(step);
    const bool is_wrong = std::any_of(step.decisions.begin(), step.decisions.end(), is_wrong_place);
    if (is_wrong && placed != nullptr && placed_at != nullptr) {
      text += (text.empty() ? "" : "; ") + std::string("from ") + short_number(core::seconds(placed_at->t_ns)) +
              " s to " + short_number(core::seconds(step.t_ns)) +
              " s the vehicle was given at a wrong place of the earlier map, " + short_number(moved_m(step, *placed)) +
              " m off, until what it mapped showed that";
    }
    if (placed != nullptr) placed_at = &step;
  }
  return text;
}

}  // namespace helixnav::reports
