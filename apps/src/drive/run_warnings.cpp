// SPDX-License-Identifier: BSD-3-Clause
#include "run_warnings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <variant>

#include "helixnav/core/errors.hpp"

namespace helixnav::apps {
namespace {

template <class... Values>
std::string warning(const char* format, Values... values) {
  std::array<char, 400> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  return buffer.data();
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

std::string no_landmark_text(const ObservationCounts& counts) {
  if (counts.seen == 0) return "the log holds no detections: nothing was mapped, and the path is that of the odometry";
  return warning(
      "the map has no landmark: of %zu detections %zu were matched and %zu began landmarks that were not seen "
      "again; are reach, mounting and noise those of this sensor? 'helixnav check' shows what was understood",
      counts.seen, counts.matched, counts.began);
}

std::string collapse_text(const ObservationCounts& counts) {
  return warning(
      "matching collapsed: of %zu detections %.0f %% were matched, %.0f %% began landmarks; odometry or detections "
      "are worse than assumed, or mounting, units or times are wrong. 'helixnav check' shows what was understood, "
      "'helixnav calibrate' estimates the noise from the log",
      counts.seen, 100.0 * share(counts.matched, counts.seen), 100.0 * share(counts.began, counts.seen));
}

std::string nis_text(double mean_per_dof) {
  const double factor = std::sqrt(std::max(mean_per_dof, 1e-6));
  if (mean_per_dof > 1.0) {
    return warning(
        "innovations are %.2g times larger than the assumed noise allows (NIS %.3g per degree of freedom): "
        "covariances are too small; 'helixnav calibrate' estimates the noise from the log",
        factor, mean_per_dof);
  }
  return warning(
      "innovations are %.2g times smaller than the assumed noise (NIS %.3g per degree of freedom): the log is better "
      "than assumed, and returns will be harder to tell apart than they need be; 'helixnav calibrate' estimates "
      "the noise from the log",
      1.0 / factor, mean_per_dof);
}

}  // namespace

void ObservationCounts::add(const core::StepReport& report) {
  seen += report.associations.size();
  for (const core::AssociationReport& a : report.associations) {
    matched += a.outcome == core::Outcome::matched ? 1 : 0;
    began += a.outcome == core::Outcome::augmented ? 1 : 0;
  }
}

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

std::vector<std::string> warnings_of(const Drive& job, const ObservationCounts& counts,
                                     const std::vector<core::MapLandmark>& map,
                                     const evaluation::Evaluation& evaluation) {
  std::vector<std::string> warnings;
  const bool mature = std::any_of(map.begin(), map.end(), [](const core::MapLandmark& landmark) {
    return landmark.state == core::LandmarkState::mature;
  });
  constexpr std::size_t enough = 200;
  constexpr double least_matched = 0.15;
  if (!mature) {
    warnings.push_back(no_landmark_text(counts));
  } else if (counts.seen >= enough && share(counts.matched, counts.seen) < least_matched) {
    warnings.push_back(collapse_text(counts));
  }
  constexpr double least_nis = 0.25, most_nis = 2.0;
  const double nis = evaluation.nis.mean_per_dof;
  if (evaluation.nis.updates >= 50 && (nis < least_nis || nis > most_nis)) warnings.push_back(nis_text(nis));
  if (evaluation.position && evaluation.position->error_m.count == 0) {
    warnings.push_back(
        warning("none of the %zu positions of truth lies within the time of the run; is it of the same clock? "
                "'helixnav evaluate' takes --truth-offset-s",
                evaluation.position->fixes_outside));
  }
  if (job.known_association && mature && counts.matched == 0) {
    warnings.emplace_back("no identity was seen twice: --association known needs identities that last");
  }
  return warnings;
}

}  // namespace helixnav::apps
