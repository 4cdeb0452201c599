// SPDX-License-Identifier: BSD-3-Clause
#include "run_warnings.hpp"

#include <algorithm>

#include "helixnav/reports/run_warnings.hpp"

namespace helixnav::apps {
namespace {

bool has_match(const core::StepReport& step) {
  return std::any_of(step.associations.begin(), step.associations.end(),
                     [](const core::AssociationReport& a) { return a.outcome == core::Outcome::matched; });
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
  return warnings;
}

}  // namespace helixnav::apps
