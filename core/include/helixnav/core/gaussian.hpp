// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::core {

/// Estimate of a pose with its covariance in the coordinates (x, y, heading) [m, m, rad].
struct PoseGaussian {
  Pose2 mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Estimate of a point with its covariance [m²].
struct PointGaussian {
  Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
};

/// Joint estimate of the robot's pose and of n landmarks, what data association needs from a filter.
/// covariance is (3+2n)×(3+2n): pose first, then (x, y) of each landmark in the order of `ids`.
struct JointGaussian {
  Pose2 pose;
  std::vector<LandmarkId> ids;
  std::vector<Eigen::Vector2d> points_m;
  Eigen::MatrixXd covariance;
};

/// Largest |M_ij − M_ji| of a square matrix, 0 of an empty one. Cost O(n²). Test: core/gaussian_test.cpp.
double asymmetry(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

/// True when `matrix` is square, finite, symmetric to 1e-9 of its largest element and positive definite.
/// Cost O(n³). Test: core/gaussian_test.cpp.
bool is_symmetric_positive_definite(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

/// Same as is_symmetric_positive_definite but accepts eigenvalues down to −1e-9 of the largest element.
/// Test: core/gaussian_test.cpp.
bool is_symmetric_positive_semidefinite(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

}  // namespace helixnav::core
