// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::association {

/// A map with a full random covariance, a truth drawn from it, and a scan of that truth. Truth is for scoring only.
struct Scene {
  core::JointGaussian map;
  core::Scan scan;
  std::vector<int> truth;  ///< for each observation the candidate's index, or −1 for clutter
};

/// A random covariance whose standard deviations are about `sigma`, with strong correlations through common modes.
inline Eigen::MatrixXd random_covariance(core::RandomStream& random, int n, double sigma) {
  const int modes = 4;
  Eigen::MatrixXd A(n, modes);
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < modes; ++k) A(i, k) = random.normal(0.0, sigma / 2.0);
  }
  Eigen::MatrixXd P = A * A.transpose();
  P.diagonal().array() += 0.1 * sigma * sigma;
  return P;
}

/// `landmarks` spread over a small patch ahead of a robot at a random pose, so that several are in each gate;
/// `observed` of them are seen; one observation in ten is clutter instead.
inline Scene crowded_scene(core::RandomStream& random, int observed, int landmarks, double sigma, double patch_m = 4.0,
                           bool mixed_kinds = false) {
  Scene scene;
  scene.map.pose = core::Pose2(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-4, 4));
  const int n = 3 + 2 * landmarks;
  Eigen::MatrixXd& P = scene.map.covariance;
  P = random_covariance(random, n, sigma);
  P.row(2) *= 0.1;
  P.col(2) *= 0.1;
  const Eigen::LLT<Eigen::MatrixXd> llt(P);
  Eigen::VectorXd error(n);
  for (int i = 0; i < n; ++i) error[i] = random.normal();
  error = llt.matrixL() * error;
  const core::Pose2 T_world_robot(scene.map.pose.vector() + error.head<3>());
  std::vector<Eigen::Vector2d> truth_m;
  for (int j = 0; j < landmarks; ++j) {
    scene.map.ids.push_back(100 + j);
    const Eigen::Vector2d local_m(8.0 + random.uniform(0, patch_m), random.uniform(-patch_m / 2, patch_m / 2));
    scene.map.points_m.push_back(core::transform(scene.map.pose, local_m));
    truth_m.push_back(scene.map.points_m.back() + error.segment<2>(3 + 2 * j));
  }
  for (int i = 0; i < observed; ++i) {
    const bool clutter = i >= landmarks || random.bernoulli(0.1);
    const Eigen::Vector2d local_m(8.0 + random.uniform(0, patch_m), random.uniform(-patch_m / 2, patch_m / 2));
    const Eigen::Vector2d point_m = clutter ? core::transform(T_world_robot, local_m) : truth_m[i];
    const auto kind =
        mixed_kinds ? static_cast<core::ObservationKind>(random.below(4)) : core::ObservationKind::range_bearing;
    core::Observation observation;
    observation.kind = kind;
    const core::ObsVector z = core::predict_observation(kind, T_world_robot, {}, point_m).z_hat;
    const int d = core::dimension(kind);
    observation.R = 0.0025 * core::ObsMatrix::Identity(d, d);
    observation.z = z;
    for (int k = 0; k < d; ++k) observation.z[k] += random.normal(0.0, 0.05);
    scene.scan.observations.push_back(observation);
    scene.truth.push_back(clutter ? -1 : i);
  }
  return scene;
}

}  // namespace helixnav::association
