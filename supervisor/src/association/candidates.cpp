// SPDX-License-Identifier: BSD-3-Clause
#include "association/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "helixnav/core/in_view.hpp"

namespace helixnav::supervisor {
namespace {

/// Where an observation places its landmark, and the uncertainty of that from pose and noise together.
struct LocatedObservation {
  Eigen::Vector2d point_m;
  double sigma_m;
};

/// Upper bound, from the trace, on the standard deviation in any direction.
double sigma_bound(const Eigen::Matrix2d& covariance) { return std::sqrt(std::max(0.0, covariance.trace())); }

std::vector<LocatedObservation> located_observations(const core::PoseGaussian& pose, const core::Scan& scan) {
  std::vector<LocatedObservation> points;
  points.reserve(scan.observations.size());
  for (const core::Observation& observation : scan.observations) {
    const core::LocatedLandmark located = core::locate_landmark(observation, pose.mean, scan.T_robot_sensor);
    const Eigen::Matrix2d covariance = located.G_pose * pose.covariance * located.G_pose.transpose() +
                                       located.G_z * Eigen::Matrix2d(observation.R) * located.G_z.transpose();
    points.push_back({located.point_world_m, sigma_bound(covariance)});
  }
  return points;
}

bool sharper(const LocatedObservation& a, const LocatedObservation& b) { return a.sigma_m < b.sigma_m; }

bool fixes_points(const core::Scan& scan) {
  return std::all_of(scan.observations.begin(), scan.observations.end(),
                     [](const core::Observation& o) { return core::dimension(o.kind) == 2; });
}

/// Whether any observation may be of the landmark whatever the correlation of their errors.
bool is_near(const std::vector<LocatedObservation>& seen, const cekf::Outlook& landmark, double sigmas) {
  return std::any_of(seen.begin(), seen.end(), [&](const LocatedObservation& s) {
    return (s.point_m - landmark.mean_m).norm() < sigmas * (s.sigma_m + landmark.sigma_bound_m);
  });
}

/// The same with the actual correlation of their errors: sigma_m is that of the landmark's position.
bool is_near(const std::vector<LocatedObservation>& seen, const core::Pose2& pose, const cekf::Outlook& landmark,
             double sigma_m, double sigmas) {
  const Eigen::Matrix<double, 2, 3>& cross = landmark.with_pose;
  return std::any_of(seen.begin(), seen.end(), [&](const LocatedObservation& s) {
    const Eigen::Vector2d arm_m = s.point_m - pose.position_m();
    const double common_m2 = cross(0, 0) + cross(1, 1) - cross(0, 2) * arm_m.y() + cross(1, 2) * arm_m.x();
    const double relative_m2 = std::max(0.0, s.sigma_m * s.sigma_m + sigma_m * sigma_m - 2.0 * common_m2);
    return (s.point_m - landmark.mean_m).squaredNorm() < sigmas * sigmas * relative_m2;
  });
}

/// How far from the sensor the landmark of any observation may be, if its deviation is no larger than the observation's.
double reach_of(const std::vector<LocatedObservation>& seen, const Eigen::Vector2d& sensor_m, double sigmas) {
  double reach_m = 0.0;
  for (const LocatedObservation& s : seen)
    reach_m = std::max(reach_m, (s.point_m - sensor_m).norm() + 2.0 * sigmas * s.sigma_m);
  return reach_m;
}

std::vector<core::LandmarkId> within(const cekf::CompressedEkf& filter, const Eigen::Vector2d& sensor_m, double reach_m,
                                     const std::vector<core::LandmarkId>& excluded) {
  std::vector<core::LandmarkId> about = filter.landmarks_within(sensor_m, reach_m);
  if (excluded.empty()) return about;
  const auto is_excluded = [&](core::LandmarkId id) {
    return std::binary_search(excluded.begin(), excluded.end(), id);
  };
  about.erase(std::remove_if(about.begin(), about.end(), is_excluded), about.end());
  return about;
}

}  // namespace

std::vector<core::LandmarkId> candidates(const cekf::CompressedEkf& filter, const core::Scan& scan, double sigmas,
                                         const std::vector<core::LandmarkId>& excluded) {
  if (scan.observations.empty()) return {};
  const core::PoseGaussian pose = filter.pose();
  const Eigen::Vector2d sensor_m = core::transform(pose.mean, scan.T_robot_sensor.position_m());
  if (!fixes_points(scan)) {
    const double reach_m = scan.field_of_view.max_range_m;
    const bool is_known = reach_m > 0.0;
    return within(filter, sensor_m, is_known ? reach_m : std::numeric_limits<double>::infinity(), excluded);
  }

  constexpr double wider = 1.5;  // the gate uses the Mahalanobis distance, this the trace and a linear step
  const std::vector<LocatedObservation> seen = located_observations(pose, scan);
  const std::vector<core::LandmarkId> about = within(filter, sensor_m, reach_of(seen, sensor_m, sigmas), excluded);
  const std::vector<cekf::Outlook> outlooks = filter.outlooks(about);
  const double least_sigma_m = std::min_element(seen.begin(), seen.end(), sharper)->sigma_m;
  const auto near_with = [&](const cekf::Outlook& landmark, double sigma_m) {
    return is_near(seen, pose.mean, landmark, sigma_m, wider * sigmas);
  };
  std::vector<core::LandmarkId> chosen, blurred;
  std::vector<const cekf::Outlook*> of_blurred;
  for (std::size_t i = 0; i < about.size(); ++i) {
    const cekf::Outlook& landmark = outlooks[i];
    if (!is_near(seen, landmark, sigmas) || !near_with(landmark, landmark.sigma_bound_m)) continue;
    const bool is_sharp = landmark.sigma_bound_m < least_sigma_m;  // its exact deviation would exclude next to nothing
    (is_sharp ? chosen : blurred).push_back(about[i]);
    if (!is_sharp) of_blurred.push_back(&landmark);
  }
  const std::vector<core::PointGaussian> exact = filter.marginals(blurred);
  for (std::size_t i = 0; i < blurred.size(); ++i) {
    if (near_with(*of_blurred[i], sigma_bound(exact[i].covariance_m2))) chosen.push_back(blurred[i]);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
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
    const bool inside = core::is_between_bearings(view, bearing_rad, margin_rad);
    if (inside && range_m > view.min_range_m + margin_m) expected.push_back(id);
  }
  return expected;
}

}  // namespace helixnav::supervisor
