// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace helixnav::core {

/// Shifts logarithms of weights so that Σ exp(log_weight) = 1 and returns the logarithm of the sum before. Weights that
/// are all −∞, or one that is NaN: NumericalError, the weights as they were.
/// Test: core/resampling_test.cpp.
double normalise(std::vector<double>& log_weight);

/// Effective sample size 1 / Σ w² of normalised weights, in [1, n]. Test: core/resampling_test.cpp.
double effective_sample_size(const std::vector<double>& log_weight);

/// Systematic resampling of normalised weights: `parents` receives m indices, i about m·w_i times (its floor or
/// ceiling), in ascending order. One uniform number `offset` in [0, 1). Cost O(n + m); allocates only when `parents`
/// grows. Test: core/resampling_test.cpp.
void systematic_parents(const std::vector<double>& log_weight, std::size_t m, double offset,
                        std::vector<std::uint32_t>& parents);

}  // namespace helixnav::core
