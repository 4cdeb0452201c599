// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "session.hpp"

namespace helixnav::smoothing {
namespace {

constexpr double smallest_damping = 1e-12;
constexpr double largest_damping = 1e12;
/// A negligible predicted decrease counts as convergence only when damping does not explain it.
constexpr double light_damping = 1e-2;

/// Step of (H + λ·diag H)s = −g; false when even the damped matrix cannot be factorised.
bool damped_step(Session& session, double damping, std::vector<double>& damped, Eigen::VectorXd& step) {
  session.equations.damp(damping, damped);
  if (session.cholesky.factorize(damped) >= 0) return false;
  session.cholesky.solve(-session.equations.gradient, step);
  return true;
}

}  // namespace

Reason levenberg_marquardt(Session& session) {
  std::vector<double> damped;
  Eigen::VectorXd step;
  double damping = session.options.first_damping;
  double growth = 2.0;
  for (int i = 0; i < session.options.max_iterations; ++i) {
    session.linearize();
    for (;;) {
      if (!(damping <= largest_damping)) return Reason::stalled;
      if (!session.may_go_on()) return Reason::stopped;
      if (damped_step(session, damping, damped, step)) {
        const double promise = session.promised_decrease(step);
        if (session.is_negligible(promise) && damping <= light_damping) return Reason::converged;
        const Chi2 trial = session.try_step(step);
        const double gain = (session.chi2.cost - trial.cost) / promise;
        if (gain > 0.0) {
          session.accept(trial, step, damping);
          damping = std::max(smallest_damping, damping * std::max(0.1, 1.0 - std::pow(2.0 * gain - 1.0, 3)));
          growth = 2.0;
          break;
        }
      }
      damping *= growth;
      growth *= 2.0;
    }
  }
  return Reason::max_iterations;
}

}  // namespace helixnav::smoothing
