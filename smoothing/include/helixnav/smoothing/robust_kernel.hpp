// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::smoothing {

/// How a landmark observation with whitened squared residual s = eᵀC⁻¹e enters the cost: ρ(s). `width` is in standard
/// deviations: residuals below it count approximately as squares.
struct RobustKernel {
  enum class Shape {
    none,    ///< ρ = s
    huber,   ///< ρ = s up to width², then 2·width·√s − width²
    cauchy,  ///< ρ = width²·log(1 + s/width²)
  };
  Shape shape = Shape::none;
  double width = 3.0;
};

/// ρ(s) and its derivative, the weight of the observation in the normal equations.
struct KernelValue {
  double cost;
  double weight;
};

/// Test: smoothing/robust_kernel_test.cpp (derivative against differences, optimum against outliers).
KernelValue evaluate(const RobustKernel& kernel, double squared_residual);

}  // namespace helixnav::smoothing
