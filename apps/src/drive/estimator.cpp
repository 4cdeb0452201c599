// SPDX-License-Identifier: BSD-3-Clause
#include "estimator.hpp"

#include <cstddef>
#include <memory>
#include <variant>

#include "common/chosen_navigator.hpp"
#include "helixnav/localization/localizer.hpp"

namespace helixnav::apps {
namespace {

localization::LocalizerOptions options_of(const supervisor::NavigatorOptions& navigator) {
  localization::LocalizerOptions options;
  options.method = navigator.method;
  options.association = navigator.association;
  options.gates = navigator.gates;
  options.extraneous_per_scan = navigator.extraneous_per_scan;
  options.candidate_sigmas = navigator.candidate_sigmas;
  return options;
}

std::vector<core::LandmarkId> landmarks_of(const std::vector<core::Label>& labels, const GivenMap& map) {
  std::vector<core::LandmarkId> landmarks;
  landmarks.reserve(labels.size());
  for (const core::Label label : labels) {
    const auto known = map.landmark_of.find(label);
    landmarks.push_back(known == map.landmark_of.end() ? core::no_landmark : known->second);
  }
  return landmarks;
}

/// [scan fed] labels: of the scans withheld an estimator hears nothing.
std::vector<std::vector<core::Label>> labels_fed(const Drive& job) {
  std::vector<std::vector<core::Label>> labels;
  for (std::size_t k = 0; k < job.recording.labels.size(); ++k) {
    if (job.withheld.empty() || !job.withheld[k]) labels.push_back(job.recording.labels[k]);
  }
  return labels;
}

/// The localizer as core::EventLoop wants it. Fixes are not used.
struct LocalizerFeed {
  localization::Localizer localizer;
  const Drive& job;
  LabelAgreement& agreement;
  std::vector<std::vector<core::Label>> labels_of;
  std::size_t scans = 0;

  std::optional<core::StepReport> take(const core::Event& event) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) localizer.move(*odometry);
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) return std::nullopt;
    return observe(*scan, scans++);
  }

  core::StepReport observe(const core::Scan& scan, std::size_t i) {
    const GivenMap& map = *job.given_map;
    if (job.recording.labels.empty()) return localizer.observe(scan);
    const std::vector<core::Label>& labels = labels_of[i];
    const core::StepReport report =
        job.known_association ? localizer.observe(scan, landmarks_of(labels, map)) : localizer.observe(scan);
    agreement.count(report, labels, map);
    return report;
  }
};

struct NavigatorDrive {
  std::vector<std::vector<core::Label>> labels;
  ChosenNavigator navigator;

  explicit NavigatorDrive(const Drive& job)
      : labels(labels_fed(job)), navigator(job.recording, job.navigator, job.known_association, labels) {}
};

}  // namespace

Estimator navigator_of(const Drive& job) {
  const auto drive = std::make_shared<NavigatorDrive>(job);
  return {[drive](const core::Event& event) { return drive->navigator.take(event); },
          [drive] { return drive->navigator.pose(); }, [drive] { return drive->navigator.map(); }};
}

Estimator localizer_of(const Drive& job, LabelAgreement& agreement) {
  const GivenMap& map = *job.given_map;
  const auto feed = std::make_shared<LocalizerFeed>(
      LocalizerFeed{localization::Localizer(job.recording.start, map.landmarks, options_of(job.navigator)), job,
                    agreement, labels_fed(job)});
  return {[feed](const core::Event& event) { return feed->take(event); }, [feed] { return feed->localizer.pose(); },
          [&map] { return map.landmarks; }};
}

}  // namespace helixnav::apps
