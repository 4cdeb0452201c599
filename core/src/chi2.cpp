// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/chi2.hpp"

#include <string>

#include <boost/math/distributions/chi_squared.hpp>

#include "helixnav/core/errors.hpp"

namespace helixnav::core {

double chi2_quantile(double probability, int dof) {
  if (!(probability > 0.0 && probability < 1.0) || dof < 1) {
    throw PreconditionError("chi2_quantile: probability must lie in (0, 1) and dof be at least 1, got " +
                            std::to_string(probability) + " and " + std::to_string(dof));
  }
  return boost::math::quantile(boost::math::chi_squared(dof), probability);
}

double chi2_cdf(double x, int dof) {
  if (!(x >= 0.0) || dof < 1) {
    throw PreconditionError("chi2_cdf: x must not be negative and dof be at least 1, got " + std::to_string(x) +
                            " and " + std::to_string(dof));
  }
  return boost::math::cdf(boost::math::chi_squared(dof), x);
}

}  // namespace helixnav::core
