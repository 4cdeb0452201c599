// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "helixnav/core/random.hpp"
#include "helixnav/smoothing/problem.hpp"

namespace helixnav::smoothing::testing {

struct RandomProblemSettings {
  int poses = 30;
  int landmarks = 12;
  double noise = 1.0;  ///< in standard deviations of each measurement; 0 gives a problem with χ² = 0 at the truth
};

/// A problem whose truth is known.
struct RandomProblem {
  Problem problem;  ///< start values: the truth, moved by about 0.1 m and 0.02 rad
  core::LandmarkGraph truth;
};

inline Eigen::Matrix3d random_covariance(core::RandomStream& random, double sigma_m, double sigma_rad) {
  Eigen::Matrix3d A;
  for (double& a : A.reshaped()) a = random.uniform(-1.0, 1.0);
  const Eigen::Vector3d scale(sigma_m, sigma_m, sigma_rad);
  return scale.asDiagonal() * Eigen::Matrix3d(A * A.transpose() + 0.5 * Eigen::Matrix3d::Identity()) *
         scale.asDiagonal();
}

/// A circle of poses with landmarks around it; odometry with full covariances and observations of all four kinds, from
/// a sensor off the robot's centre. Every landmark is seen from several poses, with at least one Cartesian observation.
inline RandomProblem random_problem(std::uint64_t seed, const RandomProblemSettings& settings = {}) {
  core::RandomStream random(seed, "random_problem");
  RandomProblem made;
  core::LandmarkGraph& truth = made.truth;
  const double turn_rad = 2.0 * core::pi / settings.poses;
  core::Pose2 pose;
  for (int i = 0; i < settings.poses; ++i) {
    truth.poses.push_back({100 + i, pose});
    pose = core::compose(pose, core::Pose2(1.0, 0.0, turn_rad));
  }
  const double radius_m = settings.poses / (2.0 * core::pi);
  for (int i = 0; i < settings.landmarks; ++i) {
    const double angle = 2.0 * core::pi * i / settings.landmarks + random.uniform(-0.1, 0.1);
    const double distance_m = radius_m + random.uniform(3.0, 6.0);
    truth.landmarks.push_back({i, {distance_m * std::cos(angle), radius_m + distance_m * std::sin(angle)}});
  }
  for (int i = 0; i + 1 < settings.poses; ++i) {
    const core::Pose2 step = core::between(truth.poses[static_cast<std::size_t>(i)].T_world_robot,
                                           truth.poses[static_cast<std::size_t>(i + 1)].T_world_robot);
    const Eigen::Matrix3d C = random_covariance(random, 0.05, 0.02);
    const Eigen::Vector3d noise = settings.noise * random.normal3(C);
    truth.pose_edges.push_back({i, i + 1, core::Pose2(step.vector() + noise), C});
  }
  const core::Pose2 T_robot_sensor(0.4, -0.2, 0.3);
  for (int i = 0; i < settings.poses; ++i) {
    for (int l = 0; l < settings.landmarks; ++l) {
      const Eigen::Vector2d& point_m = truth.landmarks[static_cast<std::size_t>(l)].point_m;
      const core::Pose2& T_world_robot = truth.poses[static_cast<std::size_t>(i)].T_world_robot;
      if ((point_m - T_world_robot.position_m()).norm() > 9.0) continue;
      const auto kind = static_cast<core::ObservationKind>((i + 3 * l) % 4);
      core::Observation observation;
      observation.kind = kind;
      observation.z = core::predict_observation(kind, T_world_robot, T_robot_sensor, point_m).z_hat;
      const int d = core::dimension(kind);
      observation.R = core::ObsMatrix::Zero(d, d);
      for (int k = 0; k < d; ++k) {
        const bool is_angle =
            kind == core::ObservationKind::bearing || (kind == core::ObservationKind::range_bearing && k == 1);
        const double sigma = is_angle ? 0.02 : 0.1;
        observation.R(k, k) = sigma * sigma;
        observation.z[k] += settings.noise * sigma * random.normal();
      }
      if (kind == core::ObservationKind::cartesian) observation.R(0, 1) = observation.R(1, 0) = 0.004;
      truth.landmark_edges.push_back({i, l, T_robot_sensor, observation});
    }
  }
  made.problem = problem_from_graph(truth);
  for (std::size_t i = 1; i < truth.poses.size(); ++i) {
    const Eigen::Vector3d away(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.02, 0.02));
    made.problem.graph.poses[i].T_world_robot = core::Pose2(truth.poses[i].T_world_robot.vector() + away);
  }
  for (auto& landmark : made.problem.graph.landmarks) {
    landmark.point_m += Eigen::Vector2d(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1));
  }
  return made;
}

}  // namespace helixnav::smoothing::testing
