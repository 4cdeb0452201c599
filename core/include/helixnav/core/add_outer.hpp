// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace helixnav::core {

/// C += A·Bᵀ with C rows × cols, A rows × depth, B cols × depth, all column-major with the strides given. `rows` must
/// be a multiple of eight. Every element is summed over depth in the same order whatever the block it falls in. Uses
/// AVX-512 or AVX2 with FMA where the processor has them, chosen once at run time, and the compiler's baseline
/// otherwise. Single-threaded, no allocation. Test: core/packed_product_test.cpp.
void add_outer(double* C, Eigen::Index stride_C, Eigen::Index rows, Eigen::Index cols, const double* A,
               Eigen::Index stride_A, const double* B, Eigen::Index stride_B, Eigen::Index depth);

/// The instruction sets add_outer has code for. The default is the best that the processor supports.
enum class Instructions { baseline, avx2, avx512 };
bool is_supported(Instructions instructions);

/// add_outer with given instructions, which must be supported.
void add_outer_with(Instructions instructions, double* C, Eigen::Index stride_C, Eigen::Index rows, Eigen::Index cols,
                    const double* A, Eigen::Index stride_A, const double* B, Eigen::Index stride_B, Eigen::Index depth);

/// Same, only blocks of C that touch its lower triangle; rows is cols rounded up to a multiple of eight.
void add_outer_lower(double* C, Eigen::Index stride_C, Eigen::Index rows, Eigen::Index cols, const double* A,
                     Eigen::Index stride_A, const double* B, Eigen::Index stride_B, Eigen::Index depth);

}  // namespace helixnav::core
