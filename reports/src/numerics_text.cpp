// SPDX-License-Identifier: BSD-3-Clause
#include "numerics_text.hpp"

#include <variant>
#include <vector>

#include "helixnav/core/decision_row.hpp"
#include "helixnav/reports/decision_sentence.hpp"

namespace helixnav::reports {
namespace {

std::string list_of(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i)
    text += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
  return text;
}

void add(std::int64_t count, const char* what, std::vector<std::string>& parts) {
  if (count > 0) parts.push_back(short_number(static_cast<double>(count)) + ' ' + what);
}

}  // namespace

core::NumericalHealth numerics_of(const runs::Run& run) {
  core::NumericalHealth sum;
  for (const core::StepReport& step : run.steps) sum.note(step.numerics);
  return sum;
}

PostponedWork postponed_in(const runs::Run& run) {
  PostponedWork postponed;
  for (const core::StepReport& step : run.steps) {
    for (const core::Decision& decision : step.decisions) {
      const core::DecisionRow row = core::row_of(decision);
      postponed.scans_thinned += row.kind == "scan" && row.verdict == "thinned";
      postponed.scans_left_out += row.kind == "scan" && row.verdict == "left-out";
      const auto* work = std::get_if<core::PostponedDecision>(&decision);
      if (work == nullptr) continue;
      postponed.associations += work->work == core::PostponedDecision::Work::association;
      postponed.windows += work->work == core::PostponedDecision::Work::window;
      postponed.drives += work->work == core::PostponedDecision::Work::drive;
    }
  }
  return postponed;
}

std::string numerics_text(const core::NumericalHealth& numerics) {
  std::vector<std::string> parts;
  add(numerics.repaired, "were done in another way (nothing is lost by it)", parts);
  add(numerics.refused, "were left undone", parts);
  std::string text = parts.empty() ? ""
                                   : "computations that failed as they were tried first: " + list_of(parts) +
                                         "; 'helixnav explain RUN' says when";
  if (!core::is_near_limit(numerics)) return text;
  return text + (text.empty() ? "" : "; ") +
         "the arithmetic came near its limit (least pivot of an innovation covariance " +
         short_number(numerics.least_pivot) + ", asymmetry " + short_number(numerics.asymmetry) +
         "): something is assumed to be known too exactly, or two landmarks are one";
}

std::string postponed_text(const PostponedWork& postponed) {
  std::vector<std::string> parts;
  add(postponed.scans_thinned, "scans were thinned out", parts);
  add(postponed.scans_left_out, "scans had names that could not be computed with", parts);
  add(postponed.associations, "associations were ended before their search was", parts);
  add(postponed.windows, "hand-overs of the filter were put off", parts);
  add(postponed.drives, "solutions of the whole drive were left out", parts);
  return parts.empty() ? "" : "work was left out or put off: " + list_of(parts);
}

}  // namespace helixnav::reports
