// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/localization/localizer.hpp"

#include <limits>
#include <string>
#include <utility>

#include "helixnav/core/check_event.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/core/pose_on_map.hpp"
#include "helixnav/core/thin_scan.hpp"
#include "nearby.hpp"
#include "update_pose.hpp"

namespace helixnav::localization {
namespace {

/// What association takes for new is not on the map, and the map is given.
core::Outcome outcome_of(const association::ObservationOutcome& observation) {
  if (observation.outcome == association::Outcome::matched) return core::Outcome::matched;
  const bool extraneous =
      observation.outcome == association::Outcome::new_landmark || observation.dropped_by_joint_test;
  return extraneous ? core::Outcome::rejected : core::Outcome::ambiguous;
}

}  // namespace

Localizer::Localizer(const core::PoseGaussian& start, const std::vector<core::MapLandmark>& map,
                     const LocalizerOptions& options)
    : options_(options), pose_(start), last_ns_(std::numeric_limits<core::Nanoseconds>::min()) {
  core::check_start(start);
  for (const core::MapLandmark& landmark : map) {
    const bool fresh = map_m_.emplace(landmark.id, landmark.point.mean_m).second;
    if (!fresh || !landmark.point.mean_m.allFinite()) {
      throw core::PreconditionError("localizer: landmark " + std::to_string(landmark.id) +
                                    (fresh ? " has no finite position" : " is twice in the map"));
    }
    appearance_.adopt(landmark.id, landmark.appearance);
  }
}

void Localizer::move(const core::Odometry& odometry) {
  core::check(odometry);
  core::check_order(last_ns_, odometry.t_ns);
  const core::Odometry motion = motion_ ? core::chain(*motion_, odometry) : odometry;
  if (!motion.T_before_after.vector().allFinite() || !motion.covariance.allFinite()) {
    throw core::NumericalError("localizer: the motion up to t_ns = " + std::to_string(odometry.t_ns) +
                               " is not finite in step " + std::to_string(step_));
  }
  motion_ = motion;
  last_ns_ = odometry.t_ns;
}

core::StepReport Localizer::observe(const core::Scan& scan) {
  check_event(scan);
  const core::PoseGaussian pose = predicted();
  if (scan.observations.size() <= core::most_observations_used) return update(pose, scan, associate(pose, scan));
  const std::vector<std::size_t> used = core::observations_to_use(scan);
  const core::Scan thin = core::thinned(scan, used);
  return update_thinned(pose, thin, associate(pose, thin), used, scan.observations.size());
}

core::StepReport Localizer::observe(const core::Scan& scan, const std::vector<core::LandmarkId>& landmarks) {
  check_event(scan);
  if (landmarks.size() != scan.observations.size()) {
    throw core::PreconditionError("observe: " + std::to_string(landmarks.size()) + " landmarks for " +
                                  std::to_string(scan.observations.size()) + " observations");
  }
  std::vector<core::AssociationReport> associations;
  for (const core::LandmarkId id : landmarks) {
    if (id != core::no_landmark && map_m_.count(id) == 0) {
      throw core::PreconditionError("observe: landmark " + std::to_string(id) + " is not on the map");
    }
    core::AssociationReport& association = associations.emplace_back();
    association.observation = static_cast<int>(associations.size()) - 1;
    association.outcome = id == core::no_landmark ? core::Outcome::rejected : core::Outcome::matched;
    association.landmark = id;
  }
  if (scan.observations.size() <= core::most_observations_used) {
    return update(predicted(), scan, {std::move(associations)});
  }
  const std::vector<std::size_t> used = core::observations_to_use(scan);
  std::vector<core::AssociationReport> those;
  for (const std::size_t i : used) {
    those.push_back(associations[i]);
    those.back().observation = static_cast<int>(those.size()) - 1;
  }
  return update_thinned(predicted(), core::thinned(scan, used), {std::move(those)}, used, associations.size());
}

/// The report names the observations as they stand in the whole scan.
core::StepReport Localizer::update_thinned(const core::PoseGaussian& pose, const core::Scan& thin,
                                           Associated associated, const std::vector<std::size_t>& used,
                                           std::size_t observations) {
  std::vector<core::AssociationReport> all = core::reports_of_none(observations);
  associated.decisions.push_back(core::thinning_decision(observations, used.size()));
  core::StepReport report = update(pose, thin, std::move(associated));
  core::name_in_whole_scan(used, all, report.associations);
  return report;
}

void Localizer::check_event(const core::Scan& scan) const {
  core::check(scan);
  core::check_order(last_ns_, scan.t_ns);
}

/// The pose after the motion since the last scan.
core::PoseGaussian Localizer::predicted() const {
  if (!motion_) return pose_;
  core::PoseOnMap pose(pose_);
  pose.move(*motion_);
  return pose.estimate();
}

core::JointGaussian Localizer::candidates(const core::PoseGaussian& pose, const core::Scan& scan) const {
  core::JointGaussian joint;
  joint.pose = pose.mean;
  const Nearby nearby(pose, scan, options_.candidate_sigmas);
  for (const auto& [id, point_m] : map_m_) {
    if (!nearby.holds(point_m)) continue;
    joint.ids.push_back(id);
    joint.points_m.push_back(point_m);
  }
  const auto size = static_cast<Eigen::Index>(3 + 2 * joint.ids.size());
  joint.covariance = Eigen::MatrixXd::Zero(size, size);
  joint.covariance.topLeftCorner<3, 3>() = pose.covariance;
  return joint;
}

Localizer::Associated Localizer::associate(const core::PoseGaussian& pose, const core::Scan& scan) const {
  const core::JointGaussian joint = candidates(pose, scan);
  association::Options how = options_.association;
  how.extraneous = association::density_in_view(scan, options_.extraneous_per_scan, how.extraneous);
  const association::Assignment assignment = association::associate(
      options_.method, association::make_innovation_problem(joint, scan, options_.gates, &appearance_), how);
  Associated associated;
  std::vector<core::AssociationReport>& reports = associated.reports;
  reports.reserve(assignment.observations.size());
  for (const association::ObservationOutcome& observation : assignment.observations) {
    const auto index = static_cast<int>(reports.size());
    reports.push_back({index, outcome_of(observation), observation.landmark, observation.nis, observation.dof,
                       observation.margin_nats});
  }
  if (assignment.budget_hit) {
    associated.decisions.emplace_back(core::PostponedDecision{core::PostponedDecision::Work::association,
                                                              static_cast<double>(reports.size()),
                                                              static_cast<double>(how.node_budget)});
  }
  return associated;
}

/// Updates the predicted pose with the matches. Nothing throws once something has changed.
core::StepReport Localizer::update(const core::PoseGaussian& pose, const core::Scan& scan, Associated associated) {
  std::vector<Sighting> sightings;
  for (const core::AssociationReport& association : associated.reports) {
    if (association.outcome != core::Outcome::matched) continue;
    const auto index = static_cast<std::size_t>(association.observation);
    sightings.push_back({association.landmark, map_m_.at(association.landmark), &scan.observations[index]});
  }
  const PoseUpdate updated = update_pose(pose, scan.T_robot_sensor, sightings, step_);
  core::StepReport report;
  report.associations = std::move(associated.reports);
  report.decisions = std::move(associated.decisions);
  report.joint_nis = updated.nis;
  report.joint_dof = updated.dof;
  report.numerics = updated.numerics;
  report.t_ns = scan.t_ns;
  report.pose = updated.pose;
  report.mapped_landmarks = static_cast<int>(map_m_.size());
  report.step = step_++;
  pose_ = updated.pose;
  motion_.reset();
  last_ns_ = scan.t_ns;
  return report;
}

}  // namespace helixnav::localization
