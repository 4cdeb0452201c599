// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"

namespace helixnav::supervisor {

/// Landmarks in the frame of the predicted vehicle, r = R(−φ)(m − p), with their joint covariance, which excludes the
/// drift common to vehicle and landmarks. O(n²). Test: supervisor/slip/relative_geometry_test.cpp (dense twin).
struct RelativeGeometry {
  explicit RelativeGeometry(const core::JointGaussian& joint);

  Eigen::Matrix2d covariance_of(std::size_t a, std::size_t b) const {
    return covariance_m2.block<2, 2>(2 * static_cast<Eigen::Index>(a), 2 * static_cast<Eigen::Index>(b));
  }

  std::vector<core::LandmarkId> ids;
  std::vector<Eigen::Vector2d> points_m;
  Eigen::MatrixXd covariance_m2;  ///< 2n×2n, (x, y) of each in turn
};

/// An observation as a point in the frame of the vehicle.
struct SeenPoint {
  int observation = 0;  ///< index in the scan
  Eigen::Vector2d point_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
};

/// The observations that fix a point, nearest to the sensor first, at most `most` of them.
std::vector<SeenPoint> seen_points(const core::Scan& scan, std::size_t most);

/// Index in a list of SeenPoint, and in a RelativeGeometry.
struct PointPair {
  std::size_t seen;
  std::size_t landmark;
};

/// Pairs linearised at a displacement δ = (t, θ) of the vehicle from its predicted pose, in that pose's frame, under which
/// landmark r is seen at R(−θ)(r − t): ν = A δ + noise of covariance S. Test: supervisor/slip/relative_geometry_test.cpp
/// (A against central differences).
struct PairEquations {
  PairEquations(const RelativeGeometry& geometry, const std::vector<SeenPoint>& seen,
                const std::vector<PointPair>& pairs, const Eigen::Vector3d& displacement);

  Eigen::VectorXd nu;
  Eigen::Matrix<double, Eigen::Dynamic, 3> A;
  Eigen::MatrixXd S;
};

/// Median distance of a landmark to its nearest neighbour [m]; infinite with fewer than two.
double median_spacing_m(const std::vector<Eigen::Vector2d>& points_m);

}  // namespace helixnav::supervisor
