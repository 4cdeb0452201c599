// SPDX-License-Identifier: BSD-3-Clause
#include "named/fit_jointly.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/core/observation.hpp"

namespace helixnav::supervisor {
namespace {

using Index = Eigen::Index;
using RowsOfPoints = std::vector<std::vector<FitRow>>;

struct Estimate {
  Eigen::VectorXd unit;  ///< places = given + root·unit
  std::vector<Eigen::Vector2d> points_m;
};

/// B with B·Bᵀ = P, also where P is singular.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& P) {
  const Eigen::LDLT<Eigen::MatrixXd> factor(P);
  Eigen::MatrixXd root = factor.matrixL();
  root *= factor.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal();
  return factor.transpositionsP().transpose() * root;
}

std::vector<FitRow> at_places(std::vector<FitRow> rows, const Eigen::VectorXd& moved) {
  for (FitRow& row : rows) {
    row.sensor = core::Pose2(Eigen::Vector3d(row.sensor.vector() + moved.segment<3>(row.first)));
  }
  return rows;
}

/// Rows of one point, with what the unit errors do to them.
struct OfPoint {
  WhitenedRows rows;
  Eigen::MatrixXd by_unit;
};

/// The normal equations with the points eliminated.
struct Reduced {
  Eigen::MatrixXd information;  ///< of the unit errors
  Eigen::VectorXd gradient;
  std::vector<Eigen::Matrix2d> own_inverse;                        ///< of each point
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, 2>> coupling;  ///< of the unit errors with it
  std::vector<Eigen::Vector2d> own_gradient;
};

Reduced reduce(const std::vector<OfPoint>& points, const Eigen::VectorXd& unit, double damping) {
  Reduced reduced;
  reduced.information.setIdentity(unit.size(), unit.size());
  reduced.gradient = -unit;
  for (const auto& [rows, by_unit] : points) {
    Eigen::Matrix2d own = rows.by_point.transpose() * rows.by_point;
    own.diagonal().array() += damping * own.trace();
    reduced.own_inverse.emplace_back(own.inverse());
    reduced.own_gradient.emplace_back(rows.by_point.transpose() * rows.residual);
    reduced.coupling.emplace_back(by_unit.transpose() * rows.by_point);
    const Eigen::Matrix<double, Eigen::Dynamic, 2> scaled = reduced.coupling.back() * reduced.own_inverse.back();
    reduced.information.noalias() += by_unit.transpose() * by_unit;
    reduced.information.noalias() -= scaled * reduced.coupling.back().transpose();
    reduced.gradient.noalias() += by_unit.transpose() * rows.residual;
    reduced.gradient.noalias() -= scaled * reduced.own_gradient.back();
  }
  return reduced;
}

Estimate stepped(const Estimate& from, const Reduced& reduced) {
  Estimate to = from;
  const Eigen::VectorXd step = reduced.information.llt().solve(reduced.gradient);
  to.unit += step;
  for (std::size_t j = 0; j < to.points_m.size(); ++j) {
    to.points_m[j] += reduced.own_inverse[j] * (reduced.own_gradient[j] - reduced.coupling[j].transpose() * step);
  }
  return to;
}

/// All rows at an estimate, and what they cost there.
struct AllRows {
  std::vector<OfPoint> points;
  double cost = 0.0;
};

std::optional<AllRows> linearise_all(const RowsOfPoints& rows, const Eigen::MatrixXd& root, const Estimate& at) {
  const Eigen::VectorXd moved = root * at.unit;
  if (!moved.allFinite()) return std::nullopt;
  AllRows all;
  all.cost = at.unit.squaredNorm();
  for (std::size_t j = 0; j < rows.size(); ++j) {
    if (!at.points_m[j].allFinite()) return std::nullopt;
    std::optional<WhitenedRows> white = whiten(at_places(rows[j], moved), at.points_m[j]);
    if (!white) return std::nullopt;
    all.cost += white->residual.squaredNorm();
    OfPoint& point = all.points.emplace_back(OfPoint{std::move(*white), {}});
    point.by_unit.resize(point.rows.residual.size(), root.cols());
    for (Index i = 0; i < point.by_unit.rows(); ++i) {
      const FitRow& row = rows[j][static_cast<std::size_t>(i)];
      point.by_unit.row(i).noalias() = point.rows.by_place.row(i) * root.middleRows(row.first, 3);
    }
  }
  if (!std::isfinite(all.cost)) return std::nullopt;
  return all;
}

JointFit finish(const RowsOfPoints& rows, const Eigen::MatrixXd& root, const Estimate& at, const AllRows& all) {
  const Reduced reduced = reduce(all.points, at.unit, 0.0);
  const Eigen::LLT<Eigen::MatrixXd> information(reduced.information);
  JointFit fit;
  fit.moved = root * at.unit;
  const Eigen::MatrixXd half = information.matrixL().solve(Eigen::MatrixXd(root.transpose()));
  fit.place_covariance = half.transpose() * half;
  fit.points_m = at.points_m;
  for (std::size_t j = 0; j < rows.size(); ++j) {
    fit.rows.push_back(at_places(rows[j], fit.moved));
    const Eigen::Matrix<double, Eigen::Dynamic, 2> through =
        information.matrixL().solve(Eigen::MatrixXd(reduced.coupling[j] * reduced.own_inverse[j]));
    fit.covariances_m2.emplace_back(reduced.own_inverse[j] + through.transpose() * through);
    fit.misfit.push_back(all.points[j].rows.residual.squaredNorm());
  }
  return fit;
}

}  // namespace

std::optional<WhitenedRows> whiten(const std::vector<FitRow>& rows, const Eigen::Vector2d& point_m) {
  constexpr double at_the_sensor_m = 1e-6;  // there no direction is defined, whatever the world's size
  const auto size = static_cast<Index>(rows.size());
  WhitenedRows white{Eigen::VectorXd(size), Eigen::MatrixX3d(size, 3), Eigen::MatrixX2d(size, 2)};
  for (Index i = 0; i < size; ++i) {
    const FitRow& row = rows[static_cast<std::size_t>(i)];
    if ((point_m - row.sensor.position_m()).norm() < at_the_sensor_m) return std::nullopt;
    const core::PredictedObservation predicted = core::predict_observation(row.kind, row.sensor, {}, point_m);
    const double weight = 1.0 / std::sqrt(row.variance);
    white.residual[i] = weight * core::innovation(row.kind, core::ObsVector::Constant(1, row.z), predicted.z_hat)[0];
    white.by_place.row(i) = weight * predicted.H_pose.row(0);
    white.by_point.row(i) = weight * predicted.H_landmark.row(0);
  }
  return white;
}

std::optional<JointFit> fit_jointly(const RowsOfPoints& rows, const Eigen::MatrixXd& P,
                                    const std::vector<Eigen::Vector2d>& starts_m) {
  constexpr int max_steps = 60;
  constexpr double settled = 1e-4;  // of χ²
  const Eigen::MatrixXd root = square_root(P);
  Estimate at{Eigen::VectorXd::Zero(P.cols()), starts_m};
  std::optional<AllRows> now = linearise_all(rows, root, at);
  if (!now) return std::nullopt;
  constexpr double undamped = 1e-9;
  double damping = 1e-3;
  for (int step = 0; step < max_steps; ++step) {
    Estimate next_at = stepped(at, reduce(now->points, at.unit, damping));
    std::optional<AllRows> next = linearise_all(rows, root, next_at);
    if (!next || next->cost > now->cost + settled) {
      damping *= 10.0;
      continue;
    }
    const bool is_small = now->cost - next->cost < settled;
    at = std::move(next_at);
    now = std::move(next);
    if (is_small && damping <= undamped) return finish(rows, root, at, *now);
    damping = is_small ? undamped : std::max(undamped, 0.1 * damping);
  }
  return std::nullopt;
}

}  // namespace helixnav::supervisor
