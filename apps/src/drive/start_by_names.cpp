// SPDX-License-Identifier: BSD-3-Clause
#include "start_by_names.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <variant>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/core/rigid_fit.hpp"
#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/supervisor/lengths.hpp"

namespace helixnav::apps {
namespace {

constexpr double start_sigma_rad = 3.0 * core::pi / 180.0;

/// Points of a scan whose names are on the map.
struct NamedPoints {
  std::vector<Eigen::Vector2d> on_map_m;
  std::vector<Eigen::Vector2d> from_robot_m;
  double sigma_m = 0.0;  ///< the largest of any observation
};

NamedPoints named_points(const core::Scan& scan, const std::vector<core::Label>& labels, const NamedMap& map) {
  NamedPoints points;
  for (std::size_t i = 0; i < std::min(labels.size(), scan.observations.size()); ++i) {
    const core::Observation& observation = scan.observations[i];
    const auto named = map.landmark_of.find(labels[i]);
    if (named == map.landmark_of.end() || core::dimension(observation.kind) < 2) continue;
    const auto point = map.point_m.find(named->second);
    if (point == map.point_m.end()) continue;
    const core::LocatedLandmark seen = core::locate_landmark(observation, core::Pose2(), scan.T_robot_sensor);
    points.on_map_m.push_back(point->second);
    points.from_robot_m.push_back(seen.point_world_m);
    const Eigen::Matrix2d covariance_m2 = seen.G_z * observation.R * seen.G_z.transpose();
    points.sigma_m = std::max(points.sigma_m, std::sqrt(covariance_m2.trace()));
  }
  return points;
}

/// The fit, if the points are far enough apart for a heading and their geometry matches the map.
std::optional<core::Pose2> fit(const NamedPoints& points, double map_sigma_m) {
  if (points.on_map_m.size() < 2) return std::nullopt;
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point_m : points.from_robot_m) middle_m += point_m;
  middle_m /= static_cast<double>(points.from_robot_m.size());
  const core::Pose2 T_map_robot = core::fit_rigidly(points.on_map_m, points.from_robot_m);
  double spread_m2 = 0.0, farthest_m = 0.0;
  for (std::size_t i = 0; i < points.on_map_m.size(); ++i) {
    const Eigen::Vector2d& seen_m = points.from_robot_m[i];
    spread_m2 += (seen_m - middle_m).squaredNorm();
    farthest_m = std::max(farthest_m, (points.on_map_m[i] - core::transform(T_map_robot, seen_m)).norm());
  }
  const double sigma_m = std::hypot(points.sigma_m, map_sigma_m);
  constexpr double most_sigmas = 4.0;
  if (sigma_m > start_sigma_rad * std::sqrt(spread_m2) || farthest_m > most_sigmas * sigma_m) return std::nullopt;
  return T_map_robot;
}

/// The pose before a motion, from the one after it.
core::PoseGaussian before(const core::Odometry& motion, const core::PoseGaussian& after) {
  const core::Pose2 back = core::inverse(motion.T_before_after);
  const core::ComposeJacobians J = core::compose_jacobians(after.mean, back);
  const core::Pose2 mean = core::compose(after.mean, back);
  const Eigen::Matrix3d by_motion = core::compose_jacobians(mean, motion.T_before_after).J_second;
  const Eigen::Matrix3d drifted =
      J.J_first * by_motion * motion.covariance * by_motion.transpose() * J.J_first.transpose();
  return {mean, J.J_first * after.covariance * J.J_first.transpose() + drifted};
}

NamedMap named(const EarlierSession& earlier) {
  NamedMap map{earlier.landmark_of, {}};
  const core::JointGaussian& joint = earlier.map.joint;
  for (std::size_t i = 0; i < joint.ids.size(); ++i) map.point_m.emplace(joint.ids[i], joint.points_m[i]);
  return map;
}

NamedMap named(const GivenMap& given) {
  NamedMap map{given.landmark_of, {}};
  for (const core::MapLandmark& landmark : given.landmarks) map.point_m.emplace(landmark.id, landmark.point.mean_m);
  return map;
}

/// Whether it may be taken as a given start (given_start), which has no covariance of its own: at most twice as uncertain.
bool is_as_if_given(const core::PoseGaussian& start, double reach_m) {
  const double sigma_m = reach_m / 60.0;
  const Eigen::Array3d given(sigma_m, sigma_m, start_sigma_rad);
  return (start.covariance.diagonal().array() <= 4.0 * given.square()).all();
}

std::string sentence(const core::Pose2& T_map_robot) {
  char text[160];
  std::snprintf(
      text, sizeof text,
      "the names of the first detections tell where the log begins on the map: (%.3g, %.3g) m, heading %.3g deg",
      T_map_robot.x_m, T_map_robot.y_m, T_map_robot.heading_rad * 180.0 / core::pi);
  return text;
}

}  // namespace

std::optional<core::PoseGaussian> start_by_names(const core::Recording& recording, const NamedMap& map,
                                                 double reach_m) {
  core::Odometry driven = core::no_motion(0);
  std::size_t scans = 0;
  for (const core::Event& event : recording.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) driven = core::chain(driven, *odometry);
    if (std::holds_alternative<core::Lost>(event)) return std::nullopt;
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    if (scans >= recording.labels.size()) return std::nullopt;
    const double sigma_m = reach_m / 60.0;
    const std::optional<core::Pose2> T_map_robot =
        fit(named_points(*scan, recording.labels[scans++], map), 0.3 * sigma_m);
    if (!T_map_robot) continue;
    const Eigen::Vector3d sigmas(sigma_m, sigma_m, start_sigma_rad);
    return before(driven, {*T_map_robot, Eigen::Matrix3d(sigmas.cwiseAbs2().asDiagonal())});
  }
  return std::nullopt;
}

std::string begin_by_names(Drive& job) {
  const bool is_sought = job.earlier && job.earlier->start.kind == SessionStart::Kind::unknown;
  const bool is_localized = job.given_map && !job.given_map->start;
  if (!job.known_association || (!is_sought && !is_localized)) return {};
  const double reach_m = logs::field_of_view_of(job.recording).reach().value_or(supervisor::reference_reach_m);
  const std::optional<core::PoseGaussian> start =
      start_by_names(job.recording, is_sought ? named(*job.earlier) : named(*job.given_map), reach_m);
  if (!start) return {};
  if (is_sought) {
    if (!is_as_if_given(*start, reach_m)) return {};
    job.earlier->start = {SessionStart::Kind::pose, start->mean};
    return sentence(start->mean);
  }
  if (!contradict(*start, job.recording.start)) return {};
  job.recording.start = *start;
  return sentence(start->mean);
}

bool contradict(const core::PoseGaussian& one, const core::PoseGaussian& other) {
  constexpr double sigmas = 5.0;
  Eigen::Vector3d apart = one.mean.vector() - other.mean.vector();
  apart.z() = core::wrap_to_pi(apart.z());
  const Eigen::Vector3d variance = one.covariance.diagonal() + other.covariance.diagonal();
  return (apart.array().square() > sigmas * sigmas * variance.array()).any();
}

}  // namespace helixnav::apps
