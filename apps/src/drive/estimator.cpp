// SPDX-License-Identifier: BSD-3-Clause
#include "estimator.hpp"

#include <memory>

#include "helixnav/localization/localizer.hpp"
#include "helixnav/supervisor/navigator.hpp"

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

}  // namespace

Estimator navigator_of(const Drive& job) {
  const auto navigator = std::make_shared<supervisor::Navigator>(job.recording.start, job.navigator);
  Estimator estimator;
  estimator.move = [navigator](const core::Odometry& odometry) { navigator->move(odometry); };
  estimator.fix = [navigator](const core::AbsoluteFix& fix) { navigator->fix(fix); };
  estimator.observe = [navigator, &job](const core::Scan& scan, std::size_t i) {
    return job.known_association ? navigator->observe(scan, job.recording.labels[i]) : navigator->observe(scan);
  };
  estimator.pose = [navigator] { return navigator->pose(); };
  estimator.map = [navigator] { return navigator->map(); };
  return estimator;
}

Estimator localizer_of(const Drive& job, LabelAgreement& agreement) {
  const GivenMap& map = *job.given_map;
  const auto localizer =
      std::make_shared<localization::Localizer>(job.recording.start, map.landmarks, options_of(job.navigator));
  Estimator estimator;
  estimator.move = [localizer](const core::Odometry& odometry) { localizer->move(odometry); };
  estimator.fix = [](const core::AbsoluteFix&) {};
  estimator.observe = [localizer, &job, &map, &agreement](const core::Scan& scan, std::size_t i) {
    const core::StepReport report = job.known_association
                                        ? localizer->observe(scan, landmarks_of(job.recording.labels[i], map))
                                        : localizer->observe(scan);
    if (!job.recording.labels.empty()) agreement.count(report, job.recording.labels[i], map);
    return report;
  };
  estimator.pose = [localizer] { return localizer->pose(); };
  estimator.map = [&map] { return map.landmarks; };
  return estimator;
}

}  // namespace helixnav::apps
