// SPDX-License-Identifier: BSD-3-Clause
#include "association/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace helixnav::supervisor {
namespace {

/// Where an observation sees its landmark, and how uncertain that is by pose and noise together.
struct SeenPoint {
  Eigen::Vector2d point_m;
  double sigma_m;
};

/// Largest standard deviation of any direction, bounded by the trace.
double sigma_bound(const Eigen::Matrix2d& covariance) { return std::sqrt(std::max(0.0, covariance.trace())); }

std::vector<SeenPoint> seen_points(const core::PoseGaussian& pose, const core::Scan& scan) {
  std::vector<SeenPoint> points;
  points.reserve(scan.observations.size());
  for (const core::Observation& observation : scan.observations) {
    const core::LocatedLandmark located = core::locate_landmark(observation, pose.mean, scan.T_robot_sensor);
    const Eigen::Matrix2d covariance = located.G_pose * pose.covariance * located.G_pose.transpose() +
                                       located.G_z * Eigen::Matrix2d(observation.R) * located.G_z.transpose();
    points.push_back({located.point_world_m, sigma_bound(covariance)});
  }
  return points;
}

bool fixes_points(const core::Scan& scan) {
  return std::all_of(scan.observations.begin(), scan.observations.end(),
                     [](const core::Observation& o) { return core::dimension(o.kind) == 2; });
}

}  // namespace

std::vector<core::LandmarkId> candidates(const cekf::CompressedEkf& filter, const core::Scan& scan, double sigmas) {
  if (scan.observations.empty()) return {};
  const core::PoseGaussian pose = filter.pose();
  const Eigen::Vector2d sensor_m = core::transform(pose.mean, scan.T_robot_sensor.position_m());
  if (!fixes_points(scan)) {
    const double reach_m = scan.field_of_view.max_range_m;
    const bool is_known = reach_m > 0.0;
    return filter.landmarks_within(sensor_m, is_known ? reach_m : std::numeric_limits<double>::infinity());
  }

  const std::vector<SeenPoint> seen = seen_points(pose, scan);
  double reach_m = 0.0;
  for (const SeenPoint& s : seen) reach_m = std::max(reach_m, (s.point_m - sensor_m).norm() + 2.0 * sigmas * s.sigma_m);

  std::vector<core::LandmarkId> chosen;
  for (const core::LandmarkId id : filter.landmarks_within(sensor_m, reach_m)) {
    const Eigen::Vector2d mean_m = filter.landmark_mean(id);
    const double sigma_m = filter.landmark_sigma_bound_m(id);
    const bool near = std::any_of(seen.begin(), seen.end(), [&](const SeenPoint& s) {
      return (s.point_m - mean_m).norm() < sigmas * (s.sigma_m + sigma_m);
    });
    if (near) chosen.push_back(id);
  }
  return chosen;
}

namespace {

/// Whether any observation may be of the landmark: sigma_m is that of the landmark's place, cross its covariance with the pose.
bool is_near(const std::vector<SeenPoint>& seen, const core::Pose2& pose, const Eigen::Vector2d& mean_m, double sigma_m,
             const Eigen::Matrix<double, 2, 3>& cross, double sigmas) {
  return std::any_of(seen.begin(), seen.end(), [&](const SeenPoint& s) {
    const Eigen::Vector2d arm_m = s.point_m - pose.position_m();
    const double common_m2 = cross(0, 0) + cross(1, 1) - cross(0, 2) * arm_m.y() + cross(1, 2) * arm_m.x();
    const double relative_m2 = std::max(0.0, s.sigma_m * s.sigma_m + sigma_m * sigma_m - 2.0 * common_m2);
    return (s.point_m - mean_m).squaredNorm() < sigmas * sigmas * relative_m2;
  });
}

}  // namespace

std::vector<core::LandmarkId> near_by_correlation(const cekf::CompressedEkf& filter, const core::Scan& scan,
                                                  std::vector<core::LandmarkId> candidates, double sigmas) {
  if (!fixes_points(scan)) return candidates;
  const core::PoseGaussian pose = filter.pose();
  const std::vector<SeenPoint> seen = seen_points(pose, scan);
  constexpr double wider = 1.5;
  const auto is_far = [&](core::LandmarkId id) {
    const Eigen::Vector2d mean_m = filter.landmark_mean(id);
    const Eigen::Matrix<double, 2, 3> cross = filter.covariance_with_pose(id);
    const auto near_with = [&](double sigma_m) {
      return is_near(seen, pose.mean, mean_m, sigma_m, cross, wider * sigmas);
    };
    return !near_with(filter.landmark_sigma_bound_m(id)) || !near_with(sigma_bound(filter.landmark(id).covariance_m2));
  };
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(), is_far), candidates.end());
  return candidates;
}

std::vector<core::LandmarkId> expected_in_view(const cekf::CompressedEkf& filter, const core::Scan& scan,
                                               double margin_m) {
  const core::FieldOfView& view = scan.field_of_view;
  const core::Pose2 T_world_sensor = core::compose(filter.pose().mean, scan.T_robot_sensor);
  const core::Pose2 T_sensor_world = core::inverse(T_world_sensor);
  std::vector<core::LandmarkId> expected;
  if (!std::isfinite(view.max_range_m) || view.max_range_m <= margin_m) return expected;
  for (const core::LandmarkId id : filter.landmarks_within(T_world_sensor.position_m(), view.max_range_m - margin_m)) {
    const Eigen::Vector2d point_m = core::transform(T_sensor_world, filter.landmark_mean(id));
    const double range_m = point_m.norm();
    const double bearing_rad = std::atan2(point_m.y(), point_m.x());
    const double margin_rad = margin_m / std::max(range_m, margin_m);
    const bool full_circle = view.max_bearing_rad - view.min_bearing_rad > 2.0 * core::pi - 1e-9;
    const bool inside = full_circle || (bearing_rad > view.min_bearing_rad + margin_rad &&
                                        bearing_rad < view.max_bearing_rad - margin_rad);
    if (inside && range_m > view.min_range_m + margin_m) expected.push_back(id);
  }
  return expected;
}

}  // namespace helixnav::supervisor
