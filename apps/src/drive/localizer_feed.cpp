// SPDX-License-Identifier: BSD-3-Clause
#include "localizer_feed.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <variant>

#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/supervisor/lengths.hpp"

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

core::PoseGaussian start_of(const Drive& job) {
  const std::optional<SessionStart>& start = job.given_map->start;
  if (!start) return job.recording.start;
  const core::FieldOfView view = logs::field_of_view_of(job.recording);
  return given_start(start->T_map_robot, view.reach().value_or(supervisor::reference_reach_m));
}

bool has_found(const core::StepReport& report) {
  return std::any_of(report.decisions.begin(), report.decisions.end(), [](const core::Decision& decision) {
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    return placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted;
  });
}

void add_placings(core::StepReport&& from, core::StepReport& report) {
  for (core::Decision& decision : from.decisions) {
    if (std::holds_alternative<core::PlacedDecision>(decision)) report.decisions.push_back(std::move(decision));
  }
}

/// The step of a vehicle that is not yet on any map: what it maps meanwhile is not reported.
core::StepReport on_no_map(const core::StepReport& own, std::size_t landmarks) {
  core::StepReport report;
  report.t_ns = own.t_ns;
  report.mode = core::Mode::searching;
  report.pose = own.pose;
  report.associations = own.associations;
  for (core::AssociationReport& a : report.associations) {
    a = {a.observation,
         core::Outcome::rejected,
         core::no_landmark,
         std::numeric_limits<double>::quiet_NaN(),
         0,
         std::numeric_limits<double>::infinity()};
  }
  report.mapped_landmarks = static_cast<int>(landmarks);
  return report;
}

}  // namespace

LocalizerFeed::LocalizerFeed(const Drive& job, std::vector<std::vector<core::Label>> labels_fed,
                             LabelAgreement& agreement)
    : job_(job), labels_of_(std::move(labels_fed)), agreement_(agreement) {
  localizer_.emplace(start_of(job), job.given_map->landmarks, options_of(job.navigator));
}

void LocalizerFeed::begin_to_look() {
  finder_.emplace(core::PoseGaussian{}, job_.navigator);
  finder_->look_for_place_in(as_drawn(*job_.given_map, job_.navigator, logs::field_of_view_of(job_.recording)));
}

std::optional<core::StepReport> LocalizerFeed::take(const core::Event& event) {
  if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
    if (localizer_) localizer_->move(*odometry);
    if (finder_) finder_->move(*odometry);
    driven_in_part_m_ += odometry->T_before_after.position_m().norm();
  }
  if (std::holds_alternative<core::Lost>(event)) lose();
  const auto* scan = std::get_if<core::Scan>(&event);
  if (scan == nullptr) return std::nullopt;
  return observe(*scan, scans_++);
}

/// The place on the map is searched for as at the start of a session that does not know it.
void LocalizerFeed::lose() {
  core::CarriedDecision carried;
  carried.from_part = part_;
  carried.part = part_ = next_part_++;
  carried.apart = 1;
  carried.driven_m = driven_in_part_m_;
  carried_.push_back(carried);
  driven_in_part_m_ = 0.0;
  localizer_.reset();
  begin_to_look();
}

core::StepReport LocalizerFeed::observe(const core::Scan& scan, std::size_t i) {
  core::StepReport report;
  if (localizer_) report = localize(scan, i);
  if (finder_) {
    core::StepReport own = finder_->observe(scan);
    if (!localizer_) report = on_no_map(own, job_.given_map->landmarks.size());
    take_place(std::move(own), report);
  }
  report.decisions.insert(report.decisions.begin(), carried_.begin(), carried_.end());
  carried_.clear();
  return report;
}

core::StepReport LocalizerFeed::localize(const core::Scan& scan, std::size_t i) {
  const GivenMap& map = *job_.given_map;
  if (job_.recording.labels.empty()) return localizer_->observe(scan);
  const std::vector<core::Label>& labels = labels_of_[i];
  const core::StepReport report =
      job_.known_association ? localizer_->observe(scan, landmarks_of(labels, map)) : localizer_->observe(scan);
  agreement_.count(report, labels, map);
  return report;
}

void LocalizerFeed::take_place(core::StepReport&& found, core::StepReport& report) {
  const bool has_place = has_found(found);
  const core::PoseGaussian pose = found.pose;
  add_placings(std::move(found), report);
  if (!has_place) return;
  part_ = 0;
  report.pose = pose;
  report.mode = core::Mode::mapping;
  localizer_.emplace(pose, job_.given_map->landmarks, options_of(job_.navigator));
  finder_.reset();
}

}  // namespace helixnav::apps
