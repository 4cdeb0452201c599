// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "helixnav/atlas/phase_factor.hpp"

namespace helixnav::atlas {
namespace {

using Eigen::Index;

/// Where a first observation puts a landmark: exactly, or somewhere on the line or circle that it allows.
Eigen::Vector2d first_guess(const core::Pose2& T_entry_robot, const SeenLandmark& seen) {
  if (core::dimension(seen.observation.kind) == 2) {
    return core::locate_landmark(seen.observation, T_entry_robot, seen.T_robot_sensor).point_world_m;
  }
  const core::Pose2 T_entry_sensor = core::compose(T_entry_robot, seen.T_robot_sensor);
  const bool is_bearing = seen.observation.kind == core::ObservationKind::bearing;
  const double range_m = is_bearing ? 3.0 : seen.observation.z[0];
  const double bearing_rad = is_bearing ? seen.observation.z[0] : 0.5 * core::pi;
  return core::transform(T_entry_sensor, range_m * Eigen::Vector2d(std::cos(bearing_rad), std::sin(bearing_rad)));
}

}  // namespace

PointPrior relative_to_pose(const core::JointGaussian& joint) {
  const Index n = 2 * static_cast<Index>(joint.ids.size());
  const Eigen::Matrix2d R = core::rotation(joint.pose.heading_rad).transpose();
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(n, n + 3);
  PointPrior prior;
  prior.ids = joint.ids;
  for (std::size_t i = 0; i < joint.ids.size(); ++i) {
    const Index row = 2 * static_cast<Index>(i);
    const Eigen::Vector2d arm_m = joint.points_m[i] - joint.pose.position_m();
    prior.points_m.push_back(R * arm_m);
    J.block<2, 2>(row, 0) = -R;
    J.block<2, 1>(row, 2) = R * Eigen::Vector2d(arm_m.y(), -arm_m.x());
    J.block<2, 2>(row, row + 3) = R;
  }
  prior.covariance = J * joint.covariance * J.transpose();
  prior.covariance = (0.5 * (prior.covariance + prior.covariance.transpose())).eval();
  return prior;
}

PhaseShape dead_reckon(const PhaseLog& log, const PointPrior* known) {
  check_log(log);
  PhaseShape shape;
  shape.ids = landmarks_of(log);
  shape.points_m.assign(shape.ids.size(), Eigen::Vector2d::Zero());
  std::vector<int> rows_seen(shape.ids.size(), 0);  // by the best observation so far
  const auto place_of = [&shape](core::LandmarkId id) {
    return static_cast<std::size_t>(std::lower_bound(shape.ids.begin(), shape.ids.end(), id) - shape.ids.begin());
  };
  for (std::size_t i = 0; known != nullptr && i < known->ids.size(); ++i) {
    const std::size_t place = place_of(known->ids[i]);
    if (place == shape.ids.size() || shape.ids[place] != known->ids[i]) continue;
    shape.points_m[place] = known->points_m[i];
    rows_seen[place] = 2;
  }
  core::Pose2 T_entry_robot;
  const auto look = [&](const std::vector<SeenLandmark>& seen) {
    for (const SeenLandmark& one : seen) {
      const std::size_t place = place_of(one.id);
      const int rows = core::dimension(one.observation.kind);
      if (rows <= rows_seen[place]) continue;
      shape.points_m[place] = first_guess(T_entry_robot, one);
      rows_seen[place] = rows;
    }
  };
  look(log.seen_at_entry);
  for (const LoggedStep& step : log.steps) {
    T_entry_robot = core::compose(T_entry_robot, step.T_before_after);
    shape.T_entry_robot.push_back(T_entry_robot);
    look(step.seen);
  }
  return shape;
}

}  // namespace helixnav::atlas
