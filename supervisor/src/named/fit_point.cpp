// SPDX-License-Identifier: BSD-3-Clause
#include "named/fit_point.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::supervisor {
namespace {

using Index = Eigen::Index;

constexpr double at_the_sensor_m = 1e-6;  // there no direction is defined, whatever the world's size

/// Derivative of a row by the coordinates of its place.
using PlaceRow = Eigen::RowVector3d;

struct Linearised {
  Eigen::VectorXd nu;
  Eigen::MatrixXd H_point;  ///< rows × 2
  std::vector<PlaceRow> H_places;
  Eigen::LLT<Eigen::MatrixXd> S;
  double nis = 0.0;
  double cost = 0.0;
  bool good = false;
};

/// H·P·Hᵀ + R, the lower half.
Eigen::MatrixXd innovation_covariance_of(const std::vector<FitRow>& rows, const std::vector<PlaceRow>& H,
                                         const Eigen::MatrixXd& P) {
  const std::size_t size = rows.size();
  Eigen::MatrixXd S(size, size);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = i == j ? rows[i].variance : 0.0;
      for (Index b = 0; b < H[j].cols(); ++b) {
        const double* column = &P(rows[i].first, rows[j].first + b);
        for (Index a = 0; a < H[i].cols(); ++a) sum += H[i][a] * column[a] * H[j][b];
      }
      S(static_cast<Index>(i), static_cast<Index>(j)) = sum;
    }
  }
  return S;
}

Linearised linearise(const std::vector<FitRow>& rows, const Eigen::MatrixXd& P, const Eigen::Vector2d& point_m) {
  Linearised l;
  const auto size = static_cast<Index>(rows.size());
  l.nu.resize(size);
  l.H_point.resize(size, 2);
  l.H_places.resize(rows.size());
  for (Index i = 0; i < size; ++i) {
    const FitRow& row = rows[static_cast<std::size_t>(i)];
    if ((point_m - row.sensor.position_m()).norm() < at_the_sensor_m) return l;
    const core::PredictedObservation predicted = core::predict_observation(row.kind, row.sensor, {}, point_m);
    l.nu[i] = core::innovation(row.kind, core::ObsVector::Constant(1, row.z), predicted.z_hat)[0];
    l.H_point.row(i) = predicted.H_landmark.row(0);
    l.H_places[static_cast<std::size_t>(i)] = predicted.H_pose.row(0);
  }
  l.S.compute(innovation_covariance_of(rows, l.H_places, P));
  if (l.S.info() != Eigen::Success) return l;
  l.nis = l.nu.dot(l.S.solve(l.nu));
  l.cost = l.nis + 2.0 * l.S.matrixLLT().diagonal().array().log().sum();
  l.good = std::isfinite(l.cost);
  return l;
}

std::vector<Eigen::Vector2d> starts(const FitRow& row, double spacing_m) {
  std::vector<Eigen::Vector2d> points;
  if (row.kind == core::ObservationKind::bearing) {
    for (const double spacings : {1.0, 3.0, 10.0, 30.0, 100.0}) {
      points.push_back(
          core::transform(row.sensor, spacings * spacing_m * Eigen::Vector2d(std::cos(row.z), std::sin(row.z))));
    }
    return points;
  }
  constexpr int around = 16;
  for (int k = 0; k < around; ++k) {
    const double angle_rad = 2.0 * core::pi * (k + 0.25) / around;
    points.push_back(row.sensor.position_m() + row.z * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
  }
  return points;
}

}  // namespace

std::optional<FittedPoint> fit_point(const std::vector<FitRow>& rows, const Eigen::MatrixXd& P,
                                     const Eigen::Vector2d& start_m, double same_m) {
  constexpr int max_steps = 60;
  const double settled_m = 1e-3 * same_m;
  Eigen::Vector2d point_m = start_m;
  Linearised now = linearise(rows, P, point_m);
  if (!now.good) return std::nullopt;
  double damping = 1e-3;
  for (int step = 0; step < max_steps; ++step) {
    const Eigen::Matrix2d information = now.H_point.transpose() * now.S.solve(now.H_point);
    const Eigen::Vector2d gradient = now.H_point.transpose() * now.S.solve(now.nu);
    Eigen::Matrix2d damped = information;
    damped.diagonal().array() += damping * information.trace();
    const Eigen::Vector2d move_m = damped.inverse() * gradient;
    if (!move_m.allFinite()) return std::nullopt;
    if ((information.inverse() * gradient).norm() < settled_m) {
      return FittedPoint{point_m, information.inverse(), now.nis, now.cost};
    }
    const Linearised next = linearise(rows, P, point_m + move_m);
    // S is held fixed while steps are judged: its own dependence on the point is not part of the Gauss-Newton descent.
    if (next.good && next.nu.dot(now.S.solve(next.nu)) <= now.nis) {
      point_m += move_m;
      now = next;
      damping = std::max(1e-9, 0.1 * damping);
    } else {
      damping *= 10.0;
    }
  }
  return std::nullopt;
}

bool looks_gaussian(const std::vector<FitRow>& rows, const Eigen::MatrixXd& P, const FittedPoint& fitted) {
  constexpr double sigmas = 3.0;
  constexpr double expected = sigmas * sigmas;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(fitted.covariance_m2);
  for (const double side_sigmas : {-sigmas, sigmas}) {
    for (Index axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d away_m = side_sigmas * std::sqrt(axes.eigenvalues()[axis]) * axes.eigenvectors().col(axis);
      const Linearised there = linearise(rows, P, fitted.point_m + away_m);
      if (!there.good) return false;
      const double rise = there.cost - fitted.cost;
      if (rise < expected / 1.6 || rise > expected * 1.6) return false;
    }
  }
  return true;
}

std::vector<FittedPoint> fit_from_everywhere(const std::vector<FitRow>& rows, const Eigen::MatrixXd& P,
                                             double spacing_m, double same_m) {
  std::vector<FittedPoint> solutions;
  for (const Eigen::Vector2d& start_m : starts(rows.back(), spacing_m)) {
    const std::optional<FittedPoint> found = fit_point(rows, P, start_m, same_m);
    if (!found || !found->covariance_m2.allFinite()) continue;
    const bool known = std::any_of(solutions.begin(), solutions.end(), [&](const FittedPoint& other) {
      return (other.point_m - found->point_m).norm() < same_m;
    });
    if (!known) solutions.push_back(*found);
  }
  std::sort(solutions.begin(), solutions.end(),
            [](const FittedPoint& a, const FittedPoint& b) { return a.cost < b.cost; });
  return solutions;
}

}  // namespace helixnav::supervisor
