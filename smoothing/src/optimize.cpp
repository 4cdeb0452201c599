// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/optimize.hpp"

#include "helixnav/smoothing/minimum.hpp"
#include "session.hpp"

namespace helixnav::smoothing {

Report optimize(Problem& problem, const Options& options) { return Minimum(problem, options).report(); }

Chi2 evaluate_chi2(const Problem& problem, const RobustKernel& kernel) {
  check_problem(problem);
  const Layout layout = make_layout(problem);
  return NormalEquations(problem, layout, kernel).evaluate(state_of(problem.graph));
}

std::string to_string(Reason reason) {
  switch (reason) {
    case Reason::converged:
      return "converged";
    case Reason::stalled:
      return "stalled";
    case Reason::stopped:
      return "stopped";
    default:
      return "max_iterations";
  }
}

std::string to_string(Ordering ordering) {
  switch (ordering) {
    case Ordering::amd:
      return "AMD";
    case Ordering::metis:
      return "METIS";
    default:
      return "least fill";
  }
}

}  // namespace helixnav::smoothing
