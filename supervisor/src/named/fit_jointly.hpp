// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "named/fit_point.hpp"

namespace helixnav::supervisor {

/// Rows of one point, each divided by its σ: residuals, and derivatives by the place of the sensor and by the point.
struct WhitenedRows {
  Eigen::VectorXd residual;
  Eigen::Matrix<double, Eigen::Dynamic, 3> by_place;
  Eigen::Matrix<double, Eigen::Dynamic, 2> by_point;
};
/// Nothing where the point is at the sensor.
std::optional<WhitenedRows> whiten(const std::vector<FitRow>& rows, const Eigen::Vector2d& point_m);

/// Points and places of the sensor that explain all sightings together best.
struct JointFit {
  std::vector<std::vector<FitRow>> rows;  ///< as given, from the places as fitted
  Eigen::VectorXd moved;                  ///< the places, from where they were before
  Eigen::MatrixXd place_covariance;
  std::vector<Eigen::Vector2d> points_m;
  std::vector<Eigen::Matrix2d> covariances_m2;
  std::vector<double> misfit;  ///< Σ(residual / σ)² of each point's rows
};

/// Least squares over the places, which are known with covariance P, and over the points, of which nothing is known but
/// `starts_m`: one vector of rows per point. Levenberg-Marquardt with the points eliminated, and the places as the square
/// root of P times unit errors, so that P may be singular. Nothing if it does not settle.
/// O(rows·places² + places³) a step. Test: supervisor/named/waiting_fit_test.cpp.
std::optional<JointFit> fit_jointly(const std::vector<std::vector<FitRow>>& rows, const Eigen::MatrixXd& P,
                                    const std::vector<Eigen::Vector2d>& starts_m);

}  // namespace helixnav::supervisor
