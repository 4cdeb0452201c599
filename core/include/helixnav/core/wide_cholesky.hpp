// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace helixnav::core {

/// L₁₁, L₂₁ of the first `count` rows and columns of a symmetric matrix given by its lower triangle, and the Schur complement of the
/// rest, in place, with the products of packed_product.hpp. The upper triangle gets arbitrary values. False when the
/// first rows are not positive definite; then the matrix holds arbitrary values. Exact twin: Eigen::LLT. A pivot that
/// is NaN is taken as positive. Allocates; O(n²·count).
/// Test: core/packed_product_test.cpp.
bool eliminate_first(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> F, Eigen::Index count);

}  // namespace helixnav::core
