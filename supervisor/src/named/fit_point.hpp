// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/observation.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::supervisor {

/// One row of a fit: what was measured, and from where. `P` below is the covariance of all places of the sensor,
/// (x, y, heading) of each.
struct FitRow {
  core::ObservationKind kind = core::ObservationKind::range;
  double z = 0.0;
  double variance = 0.0;
  core::Pose2 sensor;
  Eigen::Index first = 0;  ///< of the three coordinates of its place in P
};

/// A point that has been fitted. `cost` is νᵀS⁻¹ν + ln|S|, twice the negative log-likelihood up to a constant.
struct FittedPoint {
  Eigen::Vector2d point_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
  double nis = 0.0;
  double cost = 0.0;
};

/// Weighted least squares by Levenberg-Marquardt, S = H·P·Hᵀ + R recomputed at every step. Nothing if it has not
/// settled (a step far below `same_m`) or the point is not determined. O(rows³) a step, of which H·P·Hᵀ is O(rows²).
std::optional<FittedPoint> fit_point(const std::vector<FitRow>& rows, const Eigen::MatrixXd& P,
                                     const Eigen::Vector2d& start_m, double same_m);

/// The distinct solutions, `same_m` apart, from starts all around (ranges) or along the ray (bearings, 1 to 100 times
/// `spacing_m` away) of the last row, best first.
std::vector<FittedPoint> fit_from_everywhere(const std::vector<FitRow>& rows, const Eigen::MatrixXd& P,
                                             double spacing_m, double same_m);

/// True if the cost three standard deviations from the point, along both axes of its ellipse and on both sides, rises
/// by 9 as a Gaussian's does, within a factor of 1.6. Two basins that have merged do not pass.
bool looks_gaussian(const std::vector<FitRow>& rows, const Eigen::MatrixXd& P, const FittedPoint& fitted);

}  // namespace helixnav::supervisor
