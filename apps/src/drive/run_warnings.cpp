// SPDX-License-Identifier: BSD-3-Clause
#include "run_warnings.hpp"

#include <algorithm>
#include <cstddef>
#include <map>

#include "helixnav/reports/run_warnings.hpp"

namespace helixnav::apps {
namespace {

bool has_match(const core::StepReport& step) {
  return std::any_of(step.associations.begin(), step.associations.end(),
                     [](const core::AssociationReport& a) { return a.outcome == core::Outcome::matched; });
}

/// Empty unless sightings were left out of the landmark that they name.
std::string names_text(const runs::Run& run) {
  std::map<core::LandmarkId, std::size_t> contradicted;
  std::size_t all = 0;
  for (const core::StepReport& step : run.steps) {
    for (const core::AssociationReport& a : step.associations) {
      if (a.outcome != core::Outcome::rejected || a.landmark == core::no_landmark) continue;
      ++contradicted[a.landmark];
      ++all;
    }
  }
  if (all == 0) return {};
  const auto most = std::max_element(contradicted.begin(), contradicted.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return std::to_string(all) + " sightings contradict their names and were left out, most of them (" +
         std::to_string(most->second) + ") of landmark " + std::to_string(most->first) +
         ": identities are wrong at times, or landmarks were moved. 'helixnav explain --step N' shows a scan";
}

}  // namespace

std::vector<std::string> warnings_of(const Drive& job, const runs::Run& run, const evaluation::Evaluation& evaluation) {
  std::vector<std::string> warnings = reports::warnings_of(run, evaluation);
  const bool mature = std::any_of(run.map.begin(), run.map.end(), [](const core::MapLandmark& landmark) {
    return landmark.state == core::LandmarkState::mature;
  });
  if (job.known_association && mature && std::none_of(run.steps.begin(), run.steps.end(), has_match)) {
    warnings.emplace_back("no identity was seen twice: --association known needs identities that last");
  }
  if (job.known_association) {
    const std::string text = names_text(run);
    if (!text.empty()) warnings.push_back(text);
  }
  return warnings;
}

}  // namespace helixnav::apps
