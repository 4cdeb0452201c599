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

/// As the localizer takes it: its landmarks are where they are.
core::JointMap exact(const std::vector<core::MapLandmark>& landmarks) {
  core::JointMap map;
  std::vector<core::MapLandmark> sorted = landmarks;
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  for (const core::MapLandmark& landmark : sorted) {
    map.joint.ids.push_back(landmark.id);
    map.joint.points_m.push_back(landmark.point.mean_m);
    map.states.push_back(core::LandmarkState::mature);
    map.observations.push_back(landmark.observations);
    map.next_name = landmark.id + 1;
  }
  const auto rows = static_cast<Eigen::Index>(3 + 2 * sorted.size());
  map.joint.covariance = Eigen::MatrixXd::Zero(rows, rows);
  return map;
}

double reach_of(const Drive& job) {
  return logs::field_of_view_of(job.recording).reach().value_or(supervisor::reference_reach_m);
}

core::PoseGaussian start_of(const Drive& job) {
  const std::optional<SessionStart>& start = job.given_map->start;
  if (!start) return job.recording.start;
  const core::JointGaussian seen = seen_from(exact({}), start->T_map_robot, reach_of(job)).joint;
  return {seen.pose, seen.covariance.topLeftCorner<3, 3>()};
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

/// The step of a vehicle that is on no map yet: what it maps meanwhile stays its own.
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
    : job_(job),
      labels_of_(std::move(labels_fed)),
      agreement_(agreement),
      monitor_(job.given_map->landmarks, reach_of(job)) {
  const std::optional<SessionStart>& start = job.given_map->start;
  const bool unknown = start && start->kind == SessionStart::Kind::unknown;
  if (unknown) {
    part_ = 1;
    next_part_ = 2;
    begin_to_look();
  } else {
    localizer_.emplace(start_of(job), job.given_map->landmarks, options_of(job.navigator));
  }
}

void LocalizerFeed::begin_to_look() {
  finder_.emplace(core::PoseGaussian{}, job_.navigator);
  finder_->look_for_place_in(exact(job_.given_map->landmarks));
}

std::optional<core::StepReport> LocalizerFeed::take(const core::Event& event) {
  if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
    if (localizer_) localizer_->move(*odometry);
    if (finder_) finder_->move(*odometry);
    driven_in_part_m_ += odometry->T_before_after.position_m().norm();
    driven_m_ += odometry->T_before_after.position_m().norm();
  }
  if (std::holds_alternative<core::Lost>(event)) lose();
  const auto* scan = std::get_if<core::Scan>(&event);
  if (scan == nullptr) return std::nullopt;
  return observe(*scan, scans_++);
}

/// The place on the map is sought as at the begin of a session that does not know it.
void LocalizerFeed::lose() {
  core::CarriedDecision carried;
  carried.from_part = part_;
  carried.part = part_ = next_part_++;
  carried.apart = 1;
  carried.driven_m = driven_in_part_m_;
  carried_.push_back(carried);
  driven_in_part_m_ = 0.0;
  localizer_.reset();
  monitor_.reset();
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
  if (localizer_ && !job_.known_association) watch(scan, report);
  driven_m_ = 0.0;
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

/// Whether the finder is needed from now on, or no longer.
void LocalizerFeed::watch(const core::Scan& scan, core::StepReport& report) {
  monitor_.observe(scan, report, driven_m_);
  if (finder_ && !monitor_.is_lost()) finder_.reset();
  if (!finder_ && monitor_.is_lost() && can_be_searched(*job_.given_map)) begin_to_look();
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
  monitor_.reset();
  finder_.reset();
}

}  // namespace helixnav::apps
