// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace helixnav::testing {

/// Derivative of `f` (vector to vector) at x, column by column. `difference(a, b)` is a − b in the coordinates of f's
/// result, headings wrapped. Error about step²·|f'''|/6 + 1e-16·|f|/step.
template <class Function, class Difference>
Eigen::MatrixXd central_differences(const Function& f, const Eigen::VectorXd& x, const Difference& difference,
                                    double step = 1e-5) {
  Eigen::MatrixXd J;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Eigen::VectorXd above = x;
    Eigen::VectorXd below = x;
    above[i] += step;
    below[i] -= step;
    const Eigen::VectorXd slope = difference(f(above), f(below)) / (2.0 * step);
    if (i == 0) J.resize(slope.size(), x.size());
    J.col(i) = slope;
  }
  return J;
}

/// The same for a result without angles.
template <class Function>
Eigen::MatrixXd central_differences(const Function& f, const Eigen::VectorXd& x) {
  return central_differences(f, x, [](const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return (a - b).eval(); });
}

}  // namespace helixnav::testing
