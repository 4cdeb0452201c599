// SPDX-License-Identifier: BSD-3-Clause
#include "slip_spans.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <variant>

#include "helixnav/reports/decision_sentence.hpp"

namespace helixnav::reports {
namespace {

std::string tenths(core::Nanoseconds t_ns) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.12g", std::round(10.0 * core::seconds(t_ns)) / 10.0);
  return text.data();
}

std::string line_of(const runs::Run& run, const SlipSpan& slip) {
  const core::StepReport& step = run.steps[slip.first];
  if (slip.scans > 1) {
    return "  steps " + std::to_string(step.step) + " to " + std::to_string(run.steps[slip.last].step) + " (" +
           when_slipped(run, slip) + ")  The vehicle slipped by " + short_number(slip.moved_m) +
           " m in all, found in " + counted(slip.scans, "scan") + "; --step N tells of each.\n";
  }
  for (const core::Decision& decision : step.decisions) {
    if (!std::holds_alternative<core::SlipDecision>(decision)) continue;
    return "  step " + std::to_string(step.step) + " (" + tenths(step.t_ns) + " s)  " + sentence_of(decision) + '\n';
  }
  return {};
}

}  // namespace

std::vector<SlipSpan> slip_spans(const runs::Run& run) {
  constexpr std::size_t most_apart = 3;  // two scans between them
  std::vector<SlipSpan> slips;
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    for (const core::Decision& decision : run.steps[k].decisions) {
      const auto* slip = std::get_if<core::SlipDecision>(&decision);
      if (slip == nullptr) continue;
      if (slips.empty() || k - slips.back().last > most_apart) slips.push_back({k, k, 0, 0.0});
      SlipSpan& span = slips.back();
      span.scans += span.scans == 0 || span.last != k ? 1 : 0;
      span.last = k;
      span.moved_m += slip->moved_m;
    }
  }
  return slips;
}

std::string when_slipped(const runs::Run& run, const SlipSpan& slip) {
  const std::string first = tenths(run.steps[slip.first].t_ns);
  if (slip.first == slip.last) return "at " + first + " s";
  return "from " + first + " to " + tenths(run.steps[slip.last].t_ns) + " s";
}

std::string slips_text(const runs::Run& run) {
  constexpr std::size_t most_lines = 5;
  const std::vector<SlipSpan> slips = slip_spans(run);
  if (slips.empty()) return {};
  std::string text = "\nSlips that the odometry did not show, " + std::to_string(slips.size()) + ":\n";
  for (std::size_t i = 0; i < std::min(slips.size(), most_lines); ++i) text += line_of(run, slips[i]);
  if (slips.size() > most_lines) {
    text += "  And " + std::to_string(slips.size() - most_lines) + " more in decisions.csv.\n";
  }
  return text;
}

}  // namespace helixnav::reports
