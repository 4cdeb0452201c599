// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/observation.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::cekf {

/// An observation that has been associated with a landmark of the map.
struct Match {
  core::LandmarkId landmark = core::no_landmark;
  core::Observation observation;
  core::Pose2 T_robot_sensor;
};

/// A point known as a function of the pose and of points of the map: its error is G times their errors (pose in
/// (x, y, heading) first, then (x, y) of each landmark in the order of `ids`) plus independent noise.
struct DerivedPoint {
  Eigen::Vector2d point_m = Eigen::Vector2d::Zero();
  std::vector<core::LandmarkId> ids;
  Eigen::Matrix<double, 2, Eigen::Dynamic> G;          ///< 2×(3 + 2·ids)
  Eigen::Matrix2d noise_m2 = Eigen::Matrix2d::Zero();  ///< symmetric positive semidefinite
};

/// A measurement that is linear in points of the map: nu = H·(their errors) + noise of covariance 1, with (x, y) of each
/// landmark in the order of `ids`. Sightings from past poses become such rows once the point they are of is eliminated
/// (docs/names.md).
struct PointRows {
  std::vector<core::LandmarkId> ids;
  Eigen::MatrixXd H;   ///< m × 2·ids
  Eigen::VectorXd nu;  ///< true minus estimated
};

/// The statistics of an update: nis is νᵀS⁻¹ν or, for an iterated update, the cost J at its minimum; either is
/// χ²-distributed with dof degrees of freedom when the model holds.
struct UpdateResult {
  double nis = 0.0;
  int dof = 0;
};

/// Innovation of sightings: ν and its covariance S = H·P·Hᵀ + R, one or two rows per match, in order.
struct Innovation {
  Eigen::VectorXd nu;
  Eigen::MatrixXd S;
};

/// The same with the share of each match (or pair) in the cost, for a caller that wants to drop the worst.
struct CostByPart {
  double cost = 0.0;
  int dof = 0;
  std::vector<double> parts;
};

}  // namespace helixnav::cekf
