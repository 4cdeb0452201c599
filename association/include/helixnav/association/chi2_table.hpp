// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::association {

/// core::chi2_quantile, cached per thread: association asks for the same few probabilities at 1 … 60 degrees of freedom
/// in every scan, and one quantile costs as much as the entire gate test of a scan. Errors: as core::chi2_quantile.
double chi2_threshold(double probability, int dof);

}  // namespace helixnav::association
