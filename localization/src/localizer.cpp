// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/localization/localizer.hpp"

#include <cmath>
#include <string>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"
#include "nearby.hpp"
#include "update_pose.hpp"

namespace helixnav::localization {
namespace {

/// What is new to association is not on the map, and the map is given.
core::Outcome outcome_of(const association::ObservationOutcome& observation) {
  if (observation.outcome == association::Outcome::matched) return core::Outcome::matched;
  const bool foreign = observation.outcome == association::Outcome::new_landmark || observation.dropped_by_joint_test;
  return foreign ? core::Outcome::rejected : core::Outcome::ambiguous;
}

}  // namespace

Localizer::Localizer(const core::PoseGaussian& start, const std::vector<core::MapLandmark>& map,
                     const LocalizerOptions& options)
    : options_(options), pose_(start) {
  if (!start.mean.vector().allFinite() || !core::is_symmetric_positive_semidefinite(start.covariance)) {
    throw core::PreconditionError("localizer: the start is not finite or its covariance not positive semidefinite");
  }
  for (const core::MapLandmark& landmark : map) {
    const bool fresh = map_m_.emplace(landmark.id, landmark.point.mean_m).second;
    if (!fresh || !landmark.point.mean_m.allFinite()) {
      throw core::PreconditionError("localizer: landmark " + std::to_string(landmark.id) +
                                    (fresh ? " has no finite position" : " is twice in the map"));
    }
  }
}

void Localizer::move(const core::Odometry& odometry) { motion_ = motion_ ? core::chain(*motion_, odometry) : odometry; }

core::StepReport Localizer::observe(const core::Scan& scan) {
  predict();
  core::StepReport report;
  report.associations = associate(scan);
  update(scan, report);
  return close_step(scan, std::move(report));
}

core::StepReport Localizer::observe(const core::Scan& scan, const std::vector<core::LandmarkId>& landmarks) {
  if (landmarks.size() != scan.observations.size()) {
    throw core::PreconditionError("observe: " + std::to_string(landmarks.size()) + " landmarks for " +
                                  std::to_string(scan.observations.size()) + " observations");
  }
  core::StepReport report;
  for (const core::LandmarkId id : landmarks) {
    if (id != core::no_landmark && map_m_.count(id) == 0) {
      throw core::PreconditionError("observe: landmark " + std::to_string(id) + " is not on the map");
    }
    core::AssociationReport& association = report.associations.emplace_back();
    association.observation = static_cast<int>(report.associations.size()) - 1;
    association.outcome = id == core::no_landmark ? core::Outcome::rejected : core::Outcome::matched;
    association.landmark = id;
  }
  predict();
  update(scan, report);
  return close_step(scan, std::move(report));
}

void Localizer::predict() {
  if (!motion_) return;
  const core::ComposeJacobians J = core::compose_jacobians(pose_.mean, motion_->T_before_after);
  pose_.covariance =
      J.J_first * pose_.covariance * J.J_first.transpose() + J.J_second * motion_->covariance * J.J_second.transpose();
  pose_.mean = core::compose(pose_.mean, motion_->T_before_after);
  motion_.reset();
}

core::JointGaussian Localizer::candidates(const core::Scan& scan) const {
  core::JointGaussian joint;
  joint.pose = pose_.mean;
  const Nearby nearby(pose_, scan, options_.candidate_sigmas);
  for (const auto& [id, point_m] : map_m_) {
    if (!nearby.holds(point_m)) continue;
    joint.ids.push_back(id);
    joint.points_m.push_back(point_m);
  }
  const auto size = static_cast<Eigen::Index>(3 + 2 * joint.ids.size());
  joint.covariance = Eigen::MatrixXd::Zero(size, size);
  joint.covariance.topLeftCorner<3, 3>() = pose_.covariance;
  return joint;
}

std::vector<core::AssociationReport> Localizer::associate(const core::Scan& scan) const {
  const core::JointGaussian joint = candidates(scan);
  association::Options how = options_.association;
  if (std::isfinite(scan.field_of_view.max_range_m)) {
    how.extraneous = association::uniform_density(scan.field_of_view, options_.extraneous_per_scan);
  }
  const association::Assignment assignment =
      association::associate(options_.method, association::make_innovation_problem(joint, scan, options_.gates), how);
  std::vector<core::AssociationReport> reports;
  reports.reserve(assignment.observations.size());
  for (const association::ObservationOutcome& observation : assignment.observations) {
    const auto index = static_cast<int>(reports.size());
    reports.push_back({index, outcome_of(observation), observation.landmark, observation.nis, observation.dof,
                       observation.margin_nats});
  }
  return reports;
}

void Localizer::update(const core::Scan& scan, core::StepReport& report) {
  std::vector<Sighting> sightings;
  for (const core::AssociationReport& association : report.associations) {
    if (association.outcome != core::Outcome::matched) continue;
    const auto index = static_cast<std::size_t>(association.observation);
    sightings.push_back({association.landmark, map_m_.at(association.landmark), &scan.observations[index]});
  }
  const PoseUpdate updated = update_pose(pose_, scan.T_robot_sensor, sightings, step_);
  pose_ = updated.pose;
  report.joint_nis = updated.nis;
  report.joint_dof = updated.dof;
}

core::StepReport Localizer::close_step(const core::Scan& scan, core::StepReport report) {
  report.step = step_++;
  report.t_ns = scan.t_ns;
  report.pose = pose_;
  report.mapped_landmarks = static_cast<int>(map_m_.size());
  return report;
}

}  // namespace helixnav::localization
