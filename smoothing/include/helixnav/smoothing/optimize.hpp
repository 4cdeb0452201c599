// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "helixnav/smoothing/problem.hpp"
#include "helixnav/smoothing/robust_kernel.hpp"

namespace helixnav::smoothing {

/// Fill-reducing ordering of the Cholesky factor.
enum class Ordering {
  least_fill,  ///< AMD and METIS analysed, the one with fewer nonzeros kept
  amd,
  metis,
};

/// χ² of a state, by kind. `cost` is what is minimised: landmarks pass through the robust kernel.
struct Chi2 {
  double odometry = 0.0;
  double landmarks = 0.0;
  double priors = 0.0;  ///< priors and fixes
  double cost = 0.0;

  double total() const { return odometry + landmarks + priors; }
};

struct Iteration {
  Chi2 chi2;              ///< after the step
  double step_m = 0.0;    ///< largest move of a pose or landmark
  double step_rad = 0.0;  ///< largest turn of a pose
  double damping = 0.0;   ///< λ
};

struct Options {
  RobustKernel kernel;
  Ordering ordering = Ordering::least_fill;
  int max_iterations = 200;
  /// λ of the first Levenberg–Marquardt step. From a good start (a filter's result) 1e-8 saves half the steps: DLR from
  /// odometry takes 11 instead of 36. From a bad one 1e-4 is safer: labelled Victoria Park with softened odometry ends at
  /// χ² 9012.7 instead of 158 000.
  double first_damping = 1e-4;
  double tolerance_chi2 =
      1e-6;  ///< converged when the quadratic model predicts less than this [χ²], or 1e-11 of the cost
  /// Called before every factorisation with the accepted steps so far (none before the first); false ends the iteration
  /// at the best state found. For progress, and for a caller with a time limit. Empty: goes on.
  std::function<bool(const std::vector<Iteration>&)> go_on;
};

enum class Reason {
  converged,  ///< the quadratic model predicts no further decrease
  stalled,    ///< no damping gives a decrease although the model predicts one
  max_iterations,
  stopped,  ///< Options::go_on returned false
};

struct Report {
  Chi2 start;
  Chi2 chi2;  ///< of the solution
  int dof = 0;
  std::vector<Iteration> iterations;  ///< accepted steps
  Reason reason = Reason::max_iterations;
  Ordering ordering = Ordering::amd;  ///< the one kept
  double factor_nonzeros = 0.0;       ///< of L, with the ordering kept
};

/// Moves the graph's values to the minimum of χ² near the start. The structure is analysed once; one factorisation per step.
/// Levenberg–Marquardt: damped by λ·diag(H), gain-controlled. Errors: those of check_problem; NumericalError naming the
/// variable when H is singular at the solution, or when a residual is not finite at the start. If anything is thrown, the
/// problem is left as it was.
/// Licence: CHOLMOD's simplicial LLᵀ (LGPL); no GPL module is called.
/// Test: smoothing/optimize_test.cpp, smoothing/dlr_test.cpp (published χ² 56871.4), smoothing/victoria_park_test.cpp.
Report optimize(Problem& problem, const Options& options = {});

/// χ² of the values as they stand, by kind. Errors as check_problem.
Chi2 evaluate_chi2(const Problem& problem, const RobustKernel& kernel = {});

/// "converged", "stalled", … for reports.
std::string to_string(Reason reason);
std::string to_string(Ordering ordering);

}  // namespace helixnav::smoothing
