// SPDX-License-Identifier: BSD-3-Clause
#include "session.hpp"

namespace helixnav::smoothing {

/// Growth of the cost over the best one seen that is taken for divergence.
constexpr double divergence_factor = 1e3;

Reason gauss_newton(Session& session) {
  State best_state = session.state;
  Chi2 best_chi2 = session.chi2;
  const auto finish = [&](Reason reason) {
    if (session.chi2.cost > best_chi2.cost) {
      session.state = best_state;
      session.chi2 = best_chi2;
    }
    return reason;
  };
  Eigen::VectorXd step;
  for (int i = 0; i < session.options.max_iterations; ++i) {
    session.linearize();
    session.factorize_undamped();
    session.cholesky.solve(-session.equations.gradient, step);
    if (session.is_negligible(-session.equations.gradient.dot(step))) return finish(Reason::converged);
    const Chi2 trial = session.try_step(step);
    if (!(trial.cost < divergence_factor * best_chi2.cost)) return finish(Reason::diverged);
    session.accept(trial, step, 0.0);
    if (trial.cost < best_chi2.cost) {
      best_chi2 = trial;
      best_state = session.state;
    }
  }
  return finish(Reason::max_iterations);
}

}  // namespace helixnav::smoothing
