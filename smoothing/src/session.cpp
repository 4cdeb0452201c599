// SPDX-License-Identifier: BSD-3-Clause
#include "session.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "helixnav/smoothing/undetermined.hpp"

namespace helixnav::smoothing {

Session::Session(const Problem& given, const Options& given_options)
    : problem(given),
      options(given_options),
      layout(make_layout(given)),
      equations(given, layout, given_options.kernel),
      cholesky(equations.column_start, equations.row_index, given_options.ordering),
      state(state_of(given.graph)),
      chi2(equations.evaluate(state)),
      trial_(state) {
  if (!std::isfinite(chi2.cost)) throw core::NumericalError("smoothing: chi2 is not finite at the start");
  report.start = chi2;
  report.dof = degrees_of_freedom(given);
  report.ordering = cholesky.ordering_kept();
  report.factor_nonzeros = cholesky.nonzeros();
}

void Session::factorize_undamped() {
  const int failed = cholesky.factorize(equations.values, singular_pivot);
  if (failed < 0) return;
  const std::string message = "smoothing: the measurements do not determine " +
                              name_of_column(problem, layout, failed) + " (singular normal equations)";
  for (std::size_t i = 0; i < layout.landmark_column.size(); ++i) {
    const bool is_its = failed == layout.landmark_column[i] || failed == layout.landmark_column[i] + 1;
    if (is_its) throw UndeterminedLandmark(message, problem.graph.landmarks[i].name);
  }
  throw core::NumericalError(message);
}

Chi2 Session::try_step(const Eigen::VectorXd& step) {
  Chi2 none;
  none.cost = std::numeric_limits<double>::infinity();
  if (!step.allFinite()) return none;
  add_step(layout, step, state, trial_);
  try {
    // An object of its own: GCC lets evaluate() write into what it is assigned to, where half a sum stays when it throws.
    const Chi2 found = equations.evaluate(trial_);
    if (std::isfinite(found.cost)) return found;
  } catch (const core::NumericalError&) {  // a landmark ended up at a sensor: no step to take
  }
  return none;
}

void Session::accept(const Chi2& trial_chi2, const Eigen::VectorXd& step, double damping) {
  Iteration iteration;
  iteration.chi2 = trial_chi2;
  iteration.damping = damping;
  for (const int column : layout.pose_column) {
    if (column < 0) continue;
    iteration.step_m = std::max(iteration.step_m, step.segment<2>(column).norm());
    iteration.step_rad = std::max(iteration.step_rad, std::abs(step[column + 2]));
  }
  for (const int column : layout.landmark_column) {
    iteration.step_m = std::max(iteration.step_m, step.segment<2>(column).norm());
  }
  report.iterations.push_back(iteration);
  std::swap(state, trial_);
  chi2 = trial_chi2;
}

double Session::promised_decrease(const Eigen::VectorXd& step) {
  equations.multiply(step, H_step_);
  return -2.0 * equations.gradient.dot(step) - step.dot(H_step_);
}

}  // namespace helixnav::smoothing
