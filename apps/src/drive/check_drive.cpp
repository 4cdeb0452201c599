// SPDX-License-Identifier: BSD-3-Clause
#include "check_drive.hpp"

#include <algorithm>
#include <string>
#include <variant>

#include "helixnav/core/errors.hpp"

namespace helixnav::apps {
namespace {

void check_earlier_labels(const EarlierSession& earlier) {
  check_has_covariance(earlier.map, "--map", "--association known");
  if (earlier.landmark_of.empty()) {
    throw core::InputError(
        "--association known needs to know the names of the map's landmarks: give --map the folder "
        "of a run with --association known over a labelled log");
  }
  if (earlier.start.kind == SessionStart::Kind::unknown) {
    throw core::InputError(
        "--association known finds where it begins by two landmarks of the map that one scan names and places, and "
        "this log has no such scan near its begin: give --start end, or a pose");
  }
}

/// A carried vehicle is relocalised by the landmarks around it, in the maps of the navigator and of the localizer.
void check_carried(const Drive& job) {
  const std::vector<core::Event>& events = job.recording.events;
  const bool is_carried = std::any_of(events.begin(), events.end(),
                                      [](const auto& event) { return std::holds_alternative<core::Lost>(event); });
  if (!is_carried) return;
  if (job.given_map && !can_be_searched(*job.given_map)) {
    throw core::InputError(job.recording.name +
                           ": the vehicle was carried (lost), and the map has too few landmarks, or "
                           "too many, to look for it there");
  }
  const char* const refusing = job.known_association ? "--association known"
                               : job.fastslam.chosen ? "--filter fastslam"
                               : job.smooth          ? "--smooth"
                                                     : nullptr;
  if (refusing == nullptr) return;
  throw core::InputError(job.recording.name + ": the vehicle was carried (lost), which " + refusing +
                         " does not go with");
}

/// Detections, but none with a label.
bool names_nothing(const core::Recording& recording) {
  bool seen = false;
  for (const std::vector<core::Label>& labels : recording.labels) {
    for (const core::Label label : labels) {
      if (label != core::no_label) return false;
      seen = true;
    }
  }
  return seen || recording.labels.empty();
}

void check_labels(const Drive& job) {
  if (job.known_association && job.earlier) check_earlier_labels(*job.earlier);
  const std::string option = job.fastslam.chosen ? "--fastslam.association known" : "--association known";
  if (job.known_association && names_nothing(job.recording)) {
    throw core::InputError(
        job.recording.name + ": " + option +
        " needs a labelled log, and this one has no labels: none of its detections says of which landmark it is");
  }
  if (job.known_association && job.given_map && job.given_map->landmark_of.empty()) {
    throw core::InputError(option +
                           " needs to know the names of the map's landmarks: give --map the folder "
                           "of a run with --association known over a labelled log");
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

/// The navigator cannot map range-only or bearing-only observations without identities, FastSLAM not at all.
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

}  // namespace

void check_drive(const Drive& job) {
  check_labels(job);
  check_carried(job);
  check_observable(job);
}

}  // namespace helixnav::apps
