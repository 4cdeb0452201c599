// SPDX-License-Identifier: BSD-3-Clause
#include "search/residual_scale.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace helixnav::relocalize {

/// P(F <= f) = I_x(a, b), a and b half the degrees of freedom, x = χ²₁ / (χ²₁ + χ²₂); I_x <= x^a / (a B(a, b)) where b >= 1.
double ln_chance_of_smaller(const Residuals& smaller, const Residuals& larger) {
  const double sum = smaller.chi2 + larger.chi2;
  const double a = 0.5 * smaller.dof;
  const double b = 0.5 * larger.dof;
  if (!(sum > 0.0) || a <= 0.0 || b < 1.0) return 0.0;
  if (!(smaller.chi2 > 0.0)) return -std::numeric_limits<double>::infinity();
  const double ln_beta = std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b);
  return std::min(0.0, a * std::log(smaller.chi2 / sum) - std::log(a) - ln_beta);
}

}  // namespace helixnav::relocalize
