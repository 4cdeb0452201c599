// SPDX-License-Identifier: BSD-3-Clause
#include "frame_of_map.hpp"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "helixnav/reports/run_warnings.hpp"
#include "helixnav/runs/only_localized.hpp"

namespace helixnav::reports {
namespace {

std::vector<std::string> words_of(const std::string& command) {
  std::istringstream words(command);
  return {std::istream_iterator<std::string>(words), {}};
}

/// Of the word itself, or that of an option and its value in one word.
bool is_option(const std::string& word, const std::string& option) {
  return word == option || word.rfind(option + '=', 0) == 0;
}

bool start_is_given(const runs::Run& run) {
  const std::vector<std::string> words = words_of(run.manifest.command);
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!is_option(words[i], "--start")) continue;
    return words[i] != "--start=unknown" && (i + 1 == words.size() || words[i + 1] != "unknown");
  }
  return runs::only_localized(run);  // it starts where the log says
}

template <class Test>
bool any_decision(const runs::Run& run, const Test& test) {
  return std::any_of(run.steps.begin(), run.steps.end(), [&](const core::StepReport& step) {
    return std::any_of(step.decisions.begin(), step.decisions.end(), test);
  });
}

bool is_found_place(const core::Decision& decision) {
  const auto* placed = std::get_if<core::PlacedDecision>(&decision);
  return placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted;
}

}  // namespace

bool has_earlier_map(const runs::Run& run) {
  const std::vector<std::string> words = words_of(run.manifest.command);
  return std::any_of(words.begin(), words.end(), [](const std::string& word) { return is_option(word, "--map"); });
}

const char* frame_of_map(const runs::Run& run) {
  if (any_decision(run, [](const core::Decision& d) { return std::holds_alternative<core::FixDecision>(d); })) {
    return "fixes";
  }
  if (!has_earlier_map(run) || !place_not_found_text(run).empty()) return "start";
  return start_is_given(run) || any_decision(run, is_found_place) ? "earlier" : "start";
}

}  // namespace helixnav::reports
