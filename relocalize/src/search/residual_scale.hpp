// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::relocalize {

/// The residuals of the pairs of a place: χ² and its degrees of freedom.
struct Residuals {
  double chi2 = 0.0;
  double dof = 0.0;
};

/// Upper bound on ln P that residuals of one scale, whatever it is, are by chance this much smaller at one place than at another: their
/// ratio is F-distributed. At least one degree of freedom at the first, two at the second. Test: relocalize/residual_scale_test.cpp.
double ln_chance_of_smaller(const Residuals& smaller, const Residuals& larger);

}  // namespace helixnav::relocalize
