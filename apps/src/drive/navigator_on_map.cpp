// SPDX-License-Identifier: BSD-3-Clause
#include "navigator_on_map.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <variant>

#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/supervisor/lengths.hpp"

namespace helixnav::apps {
namespace {

bool is_unknown(const Drive& job) {
  return job.given_map->start && job.given_map->start->kind == SessionStart::Kind::unknown;
}

supervisor::Navigator begun_on_map(const Drive& job) {
  const core::FieldOfView view = logs::field_of_view_of(job.recording);
  core::JointMap map = as_drawn(*job.given_map, job.navigator, view);
  if (is_unknown(job)) {
    supervisor::Navigator navigator(core::PoseGaussian{}, job.navigator);
    navigator.look_for_place_in(map);
    return navigator;
  }
  if (job.given_map->start) {
    const double reach_m = view.reach().value_or(supervisor::reference_reach_m);
    map = seen_from(std::move(map), job.given_map->start->T_map_robot, reach_m);
  } else {
    map.joint.pose = job.recording.start.mean;
    map.joint.covariance.topLeftCorner<3, 3>() = job.recording.start.covariance;
  }
  return supervisor::Navigator::go_on_in(map, job.navigator);
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
      navigator_(begun_on_map(job)),
      is_placed_(!is_unknown(job)) {
  const core::FieldOfView view = logs::field_of_view_of(job.recording);
  if (is_placed_) start_.emplace(job.given_map->landmarks, view.reach().value_or(supervisor::reference_reach_m));
}

std::optional<core::StepReport> NavigatorOnMap::take(const core::Event& event) {
  if (std::holds_alternative<core::AbsoluteFix>(event)) return std::nullopt;
  std::optional<core::StepReport> report = navigator_.take(event);
  if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
    driven_m_ += odometry->T_before_after.position_m().norm();
  }
  if (!report) return report;
  report = on_map(*std::move(report));
  doubt_start(std::get<core::Scan>(event), *report);
  if (!job_.recording.labels.empty()) agreement_.count(*report, labels_of_[scans_], *job_.given_map);
  ++scans_;
  return report;
}

void NavigatorOnMap::doubt_start(const core::Scan& scan, const core::StepReport& report) {
  if (!is_placed_) start_.reset();
  const double driven_m = std::exchange(driven_m_, 0.0);
  if (!start_) return;
  start_->observe(scan, report, driven_m);
  const bool is_lost = start_->is_lost();
  if (is_lost) navigator_.lose({scan.t_ns});
  if (is_lost || start_->is_confirmed()) start_.reset();
}

core::StepReport NavigatorOnMap::on_map(core::StepReport report) {
  is_placed_ = is_placed_after(report.decisions, is_placed_);
  if (!is_placed_) report.mode = core::Mode::searching;
  leave_own_out(report.associations);
  for (core::RevisedScan& revised : report.revised) leave_own_out(revised.associations);
  report.merged.clear();
  report.mapped_landmarks = static_cast<int>(job_.given_map->landmarks.size());
  return report;
}

bool NavigatorOnMap::is_given(core::LandmarkId id) const { return id <= job_.given_map->landmarks.back().id; }

/// What belongs to a landmark of its own is of none of the map's.
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
