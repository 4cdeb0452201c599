// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "normal_equations.hpp"
#include "sparse/cholesky.hpp"

namespace helixnav::smoothing {

/// Pivots of an undamped H below this share of their diagonal element mean that H is singular to rounding.
inline constexpr double singular_pivot = 1e-13;

/// One run of the optimiser.
class Session {
 public:
  Session(const Problem& problem, const Options& options);

  const Problem& problem;
  const Options& options;
  Layout layout;
  NormalEquations equations;
  Cholesky cholesky;
  State state;
  Chi2 chi2;
  Report report;

  /// H and g at the state.
  void linearize() { equations.linearize(state); }

  /// Factorises the undamped H; NumericalError naming the variable when it is singular.
  void factorize_undamped();

  /// χ² after `step` in trial_; infinite cost where the model has no value.
  Chi2 try_step(const Eigen::VectorXd& step);

  /// Moves to the state of the last try_step and records it.
  void accept(const Chi2& trial_chi2, const Eigen::VectorXd& step, double damping);

  /// −2gᵀs − sᵀHs: what the quadratic model says the step will take off the cost.
  double promised_decrease(const Eigen::VectorXd& step);

  bool may_go_on() const { return !options.go_on || options.go_on(report.iterations); }

  bool is_negligible(double decrease) const {
    return decrease <= options.tolerance_chi2 || decrease <= 1e-11 * chi2.cost;
  }

 private:
  State trial_;
  Eigen::VectorXd H_step_;
};

Reason levenberg_marquardt(Session& session);

}  // namespace helixnav::smoothing
