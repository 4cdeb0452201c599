// SPDX-License-Identifier: BSD-3-Clause
#include "run_warnings.hpp"

#include <algorithm>
#include <variant>

#include "helixnav/core/errors.hpp"
#include "helixnav/reports/run_warnings.hpp"

namespace helixnav::apps {
namespace {

bool has_match(const core::StepReport& step) {
  return std::any_of(step.associations.begin(), step.associations.end(),
                     [](const core::AssociationReport& a) { return a.outcome == core::Outcome::matched; });
}

}  // namespace

/// FastSLAM begins a landmark with its first observation, so that each must place it.
void check_all_place(const core::Recording& recording) {
  for (const core::Event& event : recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    for (const core::Observation& observation : scan->observations) {
      if (core::dimension(observation.kind) == 2) continue;
      throw core::InputError(recording.name + ": holds a detection of a " +
                             (observation.kind == core::ObservationKind::range ? "range" : "bearing") +
                             " alone; --filter fastslam takes range and bearing, or points");
    }
  }
}

void check_observable(const Drive& job) {
  if (job.fastslam.chosen) return check_all_place(job.recording);
  if (job.known_association || job.given_map) return;
  std::size_t seen = 0;
  for (const core::Event& event : job.recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    for (const core::Observation& observation : scan->observations) {
      if (core::dimension(observation.kind) == 2) return;
      ++seen;
    }
  }
  if (seen == 0) return;
  throw core::InputError(job.recording.name +
                         ": all detections are ranges or bearings alone, which are mapped by their identities only: " +
                         (job.recording.labels.empty() ? "the log has none (a column id)" : "add --association known"));
}

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
