// SPDX-License-Identifier: BSD-3-Clause
#include "navigator_on_map.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <variant>

#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/supervisor/joint_map.hpp"
#include "helixnav/supervisor/lengths.hpp"

namespace helixnav::apps {
namespace {

bool is_unknown(const Drive& job) {
  return job.given_map->start && job.given_map->start->kind == SessionStart::Kind::unknown;
}

double reach_of(const Drive& job) {
  return logs::field_of_view_of(job.recording).reach().value_or(supervisor::reference_reach_m);
}

core::JointMap with_pose(core::JointMap map, const core::PoseGaussian& pose) {
  if (!map.has_covariance()) return supervisor::begun_at(std::move(map), pose);
  map.joint.pose = pose.mean;
  map.joint.covariance.topLeftCorner<3, 3>() = pose.covariance;
  return map;
}

/// The EKF beside the navigator takes measurements as they are, so neither of them has constant errors taken out.
supervisor::NavigatorOptions options_on_map(const Drive& job) {
  supervisor::NavigatorOptions options = job.navigator;
  options.noise.systematic = false;
  return options;
}

/// In a frame of its own, in which the vehicle is at this pose.
supervisor::Navigator looking_for_place(const Drive& job, const core::JointMap& map, const core::Pose2& T_own_robot) {
  supervisor::Navigator navigator(core::PoseGaussian{T_own_robot, Eigen::Matrix3d::Zero()}, options_on_map(job));
  navigator.look_for_place_in(map);
  return navigator;
}

supervisor::Navigator begun_on_map(const Drive& job, const core::JointMap& map) {
  if (is_unknown(job)) return looking_for_place(job, map, core::Pose2());
  const std::optional<SessionStart>& start = job.given_map->start;
  const core::PoseGaussian pose = start ? given_start(start->T_map_robot, reach_of(job)) : job.recording.start;
  return supervisor::Navigator::go_on_in(with_pose(map, pose), options_on_map(job));
}

localization::LocalizerOptions tracking_options(const supervisor::NavigatorOptions& navigator) {
  localization::LocalizerOptions options;
  options.method = navigator.method;
  options.association = navigator.association;
  options.gates = navigator.gates;
  options.extraneous_per_scan = navigator.extraneous_per_scan;
  options.candidate_sigmas = navigator.candidate_sigmas;
  return options;
}

/// Whether the map explains most of a scan.
bool confirms(const core::StepReport& report) {
  const auto matched = std::count_if(report.associations.begin(), report.associations.end(),
                                     [](const auto& one) { return one.outcome == core::Outcome::matched; });
  return matched >= 2 && 2 * matched >= static_cast<std::ptrdiff_t>(report.associations.size());
}

bool has_slipped(const core::StepReport& report) {
  return std::any_of(report.decisions.begin(), report.decisions.end(), [](const core::Decision& decision) {
    return std::holds_alternative<core::SlipDecision>(decision);
  });
}

bool is_lost_by_slip(const core::StepReport& report) {
  return std::any_of(report.decisions.begin(), report.decisions.end(), [](const core::Decision& decision) {
    return std::holds_alternative<core::LostBySlipDecision>(decision);
  });
}

/// After what a step decided.
bool is_placed_after(const std::vector<core::Decision>& decisions, bool is_placed) {
  for (const core::Decision& decision : decisions) {
    if (std::holds_alternative<core::CarriedDecision>(decision)) is_placed = false;
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    if (placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted && placed->part == 0) {
      is_placed = true;
    }
  }
  return is_placed;
}

}  // namespace

NavigatorOnMap::NavigatorOnMap(const Drive& job, std::vector<std::vector<core::Label>> labels_fed,
                               LabelAgreement& agreement)
    : job_(job),
      labels_of_(std::move(labels_fed)),
      agreement_(agreement),
      map_(as_drawn(*job.given_map, job.navigator, logs::field_of_view_of(job.recording))),
      reach_m_(reach_of(job)),
      navigator_(begun_on_map(job, map_)),
      is_placed_(!is_unknown(job)),
      monitor_(job.given_map->landmarks, reach_m_),
      is_start_in_doubt_(is_placed_) {
  if (is_placed_) check_.emplace(map_, navigator_.pose().mean, reach_m_, options_on_map(job));
}

std::optional<core::StepReport> NavigatorOnMap::take(const core::Event& event) {
  if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
    driven_m_ += odometry->T_before_after.position_m().norm();
    if (tracker_) tracker_->move(*odometry);
    navigator_.move(*odometry);
  }
  if (const auto* lost = std::get_if<core::Lost>(&event)) {
    tracker_.reset();
    navigator_.lose(*lost);
  }
  const auto* scan = std::get_if<core::Scan>(&event);
  if (scan == nullptr) {
    if (check_) check_->take(event, nullptr, [this] { return believed(); });
    return std::nullopt;
  }
  core::StepReport report = observe(*scan);
  if (std::optional<core::StepReport> checked = checked_start(event, report)) report = std::move(*checked);
  if (!job_.recording.labels.empty()) agreement_.count(report, labels_of_[scans_], *job_.given_map);
  report.step = static_cast<std::int64_t>(scans_++);
  return report;
}

core::StepReport NavigatorOnMap::observe(const core::Scan& scan) {
  const double driven_m = std::exchange(driven_m_, 0.0);
  core::StepReport navigated = on_map(navigator_.observe(scan));
  if (tracker_) {
    core::StepReport tracked = tracker_->observe(scan);
    monitor_.observe(scan, tracked, driven_m);
    // Carried, or everything in view has vanished, as the navigator has found out.
    const bool is_contradicted = (!is_placed_ || is_lost_by_slip(navigated)) && !confirms(tracked);
    if (!is_placed_ && !is_contradicted) track_from(tracked.pose);
    if (knows_better(navigated, tracked)) {
      track_from(navigator_.filter().pose());
      monitor_.reset();
      return navigated;
    }
    if (!is_contradicted && monitor_.since_confirmed_m() <= reach_m_) return tracked;
    tracker_.reset();
    monitor_.reset();
    return navigated;
  }
  if (!is_placed_) {
    is_start_in_doubt_ = false;
    monitor_.reset();
    return navigated;
  }
  monitor_.observe(scan, navigated, driven_m);
  is_start_in_doubt_ = is_start_in_doubt_ && !monitor_.is_confirmed();
  if (is_start_in_doubt_ && monitor_.is_lost()) {
    is_start_in_doubt_ = false;
    return begin_anew(scan, navigated);
  }
  if (monitor_.is_confirmed() && navigated.mode == core::Mode::mapping) {
    track_from(navigator_.filter().pose());
  }
  return navigated;
}

std::optional<core::StepReport> NavigatorOnMap::checked_start(const core::Event& event,
                                                              const core::StepReport& report) {
  if (!check_) return std::nullopt;
  check_->take(event, &report, [this] { return believed(); });
  std::optional<StartCheck::RightStart> right = check_->right_start();
  is_start_ambiguous_ = check_->is_ambiguous();
  if (check_->is_over()) check_.reset();
  if (!right) return std::nullopt;
  navigator_ = std::move(right->navigator);
  tracker_.reset();
  monitor_.reset();
  std::vector<core::StampedPose> path = std::move(right->report.solved);
  core::StepReport placed = on_map(std::move(right->report));
  placed.solved = std::move(path);
  return placed;
}

/// After a slip, which the navigator considers and the EKF does not: if the map explains the observations from the navigator's pose and not
/// from the tracked one, at once if a slip was decided, else after two consecutive scans.
bool NavigatorOnMap::knows_better(const core::StepReport& navigated, const core::StepReport& tracked) {
  const bool is_better =
      is_placed_ && navigated.mode == core::Mode::mapping && confirms(navigated) && !confirms(tracked);
  better_scans_ = is_better ? better_scans_ + 1 : 0;
  return is_better && (has_slipped(navigated) || better_scans_ >= 2);
}

/// Begins anew, as a vehicle that does not know where on the map it is: everything mapped so far was put in wrong places of it. The
/// path so far, relative to the start that was given, belongs to the part that begins.
core::StepReport NavigatorOnMap::begin_anew(const core::Scan& scan, const core::StepReport& report) {
  is_placed_ = false;
  navigator_ = looking_for_place(job_, map_, report.pose.mean);
  core::StepReport anew = on_map(navigator_.observe(scan));
  core::CarriedDecision carried;
  carried.part = carried.apart = 1;
  carried.cause = core::CarriedDecision::Cause::wrong_start;
  carried.scans = static_cast<int>(scans_);
  anew.decisions.insert(anew.decisions.begin(), carried);
  return anew;
}

/// Resets the navigator, too, if it has left the map meanwhile.
void NavigatorOnMap::track_from(const core::PoseGaussian& pose) {
  better_scans_ = 0;
  tracker_.emplace(pose, job_.given_map->landmarks, tracking_options(job_.navigator));
  if (is_placed_) return;
  navigator_ = supervisor::Navigator::go_on_in(with_pose(map_, pose), options_on_map(job_));
  is_placed_ = true;
}

core::StepReport NavigatorOnMap::on_map(core::StepReport report) {
  is_placed_ = is_placed_after(report.decisions, is_placed_);
  if (!is_placed_) report.mode = core::Mode::searching;
  leave_own_out(report.associations);
  report.revised.clear();  // reports on earlier scans may have been the tracker's
  report.solved.clear();
  report.merged.clear();
  report.mapped_landmarks = static_cast<int>(job_.given_map->landmarks.size());
  return report;
}

bool NavigatorOnMap::is_given(core::LandmarkId id) const { return id <= job_.given_map->landmarks.back().id; }

/// Observations of the navigator's own landmarks belong to none of the map's.
void NavigatorOnMap::leave_own_out(std::vector<core::AssociationReport>& associations) const {
  for (core::AssociationReport& one : associations) {
    if (one.landmark == core::no_landmark || (is_placed_ && is_given(one.landmark))) continue;
    const bool is_used = one.outcome == core::Outcome::matched || one.outcome == core::Outcome::augmented;
    one = {one.observation,
           is_used ? core::Outcome::rejected : one.outcome,
           core::no_landmark,
           std::numeric_limits<double>::quiet_NaN(),
           0,
           std::numeric_limits<double>::infinity()};
  }
}

}  // namespace helixnav::apps
