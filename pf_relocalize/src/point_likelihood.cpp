// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/point_likelihood.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/core/errors.hpp"

namespace helixnav::pf_relocalize {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

const double log_two_pi = std::log(2.0 * core::pi);

double log_normal(const Vector2d& difference, const Matrix2d& covariance) {
  const Eigen::LLT<Matrix2d> llt(covariance);
  if (llt.info() != Eigen::Success) {
    throw core::PreconditionError("point likelihood: a covariance is not positive definite");
  }
  const Vector2d white = llt.matrixL().solve(difference);
  return -log_two_pi - std::log(llt.matrixLLT().diagonal().prod()) - 0.5 * white.squaredNorm();
}

/// Nodes and weights of ∫ f(s) N(s; 0, 1) ds.
struct Rule {
  int order;
  std::array<double, 5> nodes;
  std::array<double, 5> weights;
};

Rule hermite_rule(int order) {
  if (order == 3) {
    const double s = std::sqrt(3.0);
    return {3, {-s, 0.0, s, 0.0, 0.0}, {1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0, 0.0, 0.0}};
  }
  if (order != 5) throw core::PreconditionError("log_likelihood_gauss_hermite: order must be 3 or 5");
  const double root = std::sqrt(10.0);
  const double inner = std::sqrt(5.0 - root), outer = std::sqrt(5.0 + root);
  const double w_inner = (7.0 + 2.0 * root) / 60.0, w_outer = (7.0 - 2.0 * root) / 60.0;
  return {5, {-outer, -inner, 0.0, inner, outer}, {w_outer, w_inner, 8.0 / 15.0, w_inner, w_outer}};
}

/// The integrand of eq (9) in the noise y of the observation, z + y the noise-free value: N(y; 0, R) · |∂m/∂z| ·
/// N(m(z + y); µ, Σ), for range and bearing.
class Integrand {
 public:
  Integrand(const core::Observation& observation, const core::Pose2& T_world_robot, const core::Pose2& T_robot_sensor,
            const core::PointGaussian& landmark)
      : T_world_sensor_(core::compose(T_world_robot, T_robot_sensor)),
        z_(observation.z),
        R_(observation.R),
        noise_information_(R_.inverse()),
        landmark_(landmark),
        map_information_(landmark.covariance_m2.inverse()) {}

  double range(const Vector2d& y) const { return z_[0] + y[0]; }

  /// log of the integrand; −∞ behind the sensor.
  double log_value(const Vector2d& y) const {
    if (range(y) <= 0.0) return -std::numeric_limits<double>::infinity();
    return log_normal(y, R_) + std::log(range(y)) + log_normal(residual(y), landmark_.covariance_m2);
  }

  /// Gradient and Hessian of −log_value. The Hessian holds the curvature of the arc where that keeps it positive
  /// definite, else the Gauss–Newton part.
  void derivatives(const Vector2d& y, Vector2d& gradient, Matrix2d& hessian) const {
    const double r = range(y), angle = T_world_sensor_.heading_rad + z_[1] + y[1];
    const Vector2d e(std::cos(angle), std::sin(angle)), t(-e.y(), e.x());
    Matrix2d J;
    J << e, r * t;
    const Vector2d force = map_information_ * residual(y);
    gradient = noise_information_ * y + J.transpose() * force - Vector2d(1.0 / r, 0.0);
    const Matrix2d gauss_newton = noise_information_ + J.transpose() * map_information_ * J;
    Matrix2d curvature;
    curvature << 1.0 / (r * r), t.dot(force), t.dot(force), -r * e.dot(force);
    hessian = gauss_newton + curvature;
    if (hessian(0, 0) <= 0.1 * gauss_newton(0, 0) || hessian.determinant() <= 0.1 * gauss_newton.determinant()) {
      hessian = gauss_newton;
    }
  }

 private:
  Vector2d residual(const Vector2d& y) const {
    const double angle = T_world_sensor_.heading_rad + z_[1] + y[1];
    return T_world_sensor_.position_m() + range(y) * Vector2d(std::cos(angle), std::sin(angle)) - landmark_.mean_m;
  }

  core::Pose2 T_world_sensor_;
  Vector2d z_;
  Matrix2d R_, noise_information_;
  core::PointGaussian landmark_;
  Matrix2d map_information_;
};

/// Newton's method with step halving; stays in front of the sensor.
Vector2d mode_of(const Integrand& integrand) {
  Vector2d y = Vector2d::Zero(), gradient;
  Matrix2d hessian;
  double value = integrand.log_value(y);
  for (int iteration = 0; iteration < 20; ++iteration) {
    integrand.derivatives(y, gradient, hessian);
    Vector2d step = -hessian.ldlt().solve(gradient);
    if (gradient.dot(hessian.inverse() * gradient) < 1e-16) break;
    double next = integrand.log_value(y + step);
    for (int halving = 0; halving < 20 && !(next >= value); ++halving) {
      step *= 0.5;
      next = integrand.log_value(y + step);
    }
    if (!(next >= value)) break;
    y += step;
    value = next;
  }
  return y;
}

}  // namespace

double log_likelihood_linearised(const core::Observation& observation, const core::Pose2& T_world_robot,
                                 const core::Pose2& T_robot_sensor, const core::PointGaussian& landmark) {
  const core::LocatedLandmark located = core::locate_landmark(observation, T_world_robot, T_robot_sensor);
  const Matrix2d S = landmark.covariance_m2 + located.G_z * observation.R * located.G_z.transpose();
  return std::log(std::abs(located.G_z.determinant())) + log_normal(located.point_world_m - landmark.mean_m, S);
}

double log_likelihood_gauss_hermite(const core::Observation& observation, const core::Pose2& T_world_robot,
                                    const core::Pose2& T_robot_sensor, const core::PointGaussian& landmark, int order) {
  const Rule rule = hermite_rule(order);
  if (observation.kind != core::ObservationKind::range_bearing) {
    return log_likelihood_linearised(observation, T_world_robot, T_robot_sensor, landmark);
  }
  const Integrand integrand(observation, T_world_robot, T_robot_sensor, landmark);
  const Vector2d mode = mode_of(integrand);
  Vector2d gradient;
  Matrix2d hessian;
  integrand.derivatives(mode, gradient, hessian);
  const Matrix2d L = Matrix2d(hessian.inverse()).llt().matrixL();
  const double at_mode = integrand.log_value(mode);
  double sum = 0.0;
  for (int i = 0; i < rule.order; ++i) {
    for (int j = 0; j < rule.order; ++j) {
      const Vector2d s(rule.nodes[static_cast<std::size_t>(i)], rule.nodes[static_cast<std::size_t>(j)]);
      const double weight = rule.weights[static_cast<std::size_t>(i)] * rule.weights[static_cast<std::size_t>(j)];
      sum += weight * std::exp(integrand.log_value(mode + L * s) - at_mode + 0.5 * s.squaredNorm());
    }
  }
  return at_mode + std::log(sum) + log_two_pi + std::log(L.diagonal().prod());
}

}  // namespace helixnav::pf_relocalize
