// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::core {

/// x with P(χ²_dof ≤ x) = probability; probability in (0, 1), dof ≥ 1, else PreconditionError. Boost.Math; a call costs
/// about a microsecond: keep the value where it is needed in a loop.
/// Test: core/chi2_test.cpp against tabulated values.
double chi2_quantile(double probability, int dof);

/// P(χ²_dof ≤ x); x ≥ 0, dof ≥ 1, else PreconditionError. Test: core/chi2_test.cpp.
double chi2_cdf(double x, int dof);

}  // namespace helixnav::core
