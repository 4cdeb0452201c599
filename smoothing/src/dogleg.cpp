// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "session.hpp"

namespace helixnav::smoothing {
namespace {

constexpr double smallest_radius = 1e-9;

/// Steepest descent and Gauss–Newton step at one point, in the coordinates D·s with D = diag(H)^½, where a length counts
/// standard deviations.
struct Legs {
  Eigen::VectorXd D;
  Eigen::VectorXd cauchy;
  Eigen::VectorXd newton;
};

Legs make_legs(Session& session) {
  Legs legs;
  const Eigen::VectorXd& g = session.equations.gradient;
  legs.D = session.equations.diagonal().cwiseSqrt();
  Eigen::VectorXd step;
  session.cholesky.solve(-g, step);
  legs.newton = legs.D.cwiseProduct(step);
  const Eigen::VectorXd scaled_gradient = g.cwiseQuotient(legs.D);
  Eigen::VectorXd H_descent;
  session.equations.multiply(scaled_gradient.cwiseQuotient(legs.D), H_descent);
  const double curvature = scaled_gradient.cwiseQuotient(legs.D).dot(H_descent);
  legs.cauchy = -(scaled_gradient.squaredNorm() / curvature) * scaled_gradient;
  return legs;
}

/// The point at distance `radius` on the path origin – Cauchy point – Gauss–Newton point, in scaled coordinates.
Eigen::VectorXd on_path(const Legs& legs, double radius) {
  if (legs.newton.norm() <= radius) return legs.newton;
  const double cauchy_length = legs.cauchy.norm();
  if (cauchy_length >= radius) return (radius / cauchy_length) * legs.cauchy;
  const Eigen::VectorXd leg = legs.newton - legs.cauchy;
  const double a = leg.squaredNorm();
  const double b = legs.cauchy.dot(leg);
  const double c = cauchy_length * cauchy_length - radius * radius;
  return legs.cauchy + ((-b + std::sqrt(b * b - a * c)) / a) * leg;
}

}  // namespace

Reason dogleg(Session& session) {
  double radius = 0.0;
  for (int i = 0; i < session.options.max_iterations; ++i) {
    session.linearize();
    session.factorize_undamped();
    const Legs legs = make_legs(session);
    if (radius == 0.0) radius = legs.newton.norm();
    const double whole_promise = session.promised_decrease(legs.newton.cwiseQuotient(legs.D));
    if (session.is_negligible(whole_promise)) return Reason::converged;
    for (;;) {
      if (radius < smallest_radius) return Reason::stalled;
      const Eigen::VectorXd scaled_step = on_path(legs, radius);
      const Eigen::VectorXd step = scaled_step.cwiseQuotient(legs.D);
      const Chi2 trial = session.try_step(step);
      const double gain = (session.chi2.cost - trial.cost) / session.promised_decrease(step);
      const double tried_radius = radius;
      if (gain > 0.75) radius = std::max(radius, 3.0 * scaled_step.norm());
      if (!(gain > 0.25)) radius = 0.25 * scaled_step.norm();
      if (gain > 0.0) {
        session.accept(trial, step, tried_radius);
        break;
      }
    }
  }
  return Reason::max_iterations;
}

}  // namespace helixnav::smoothing
