// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/robust_kernel.hpp"

#include <cmath>

namespace helixnav::smoothing {

KernelValue evaluate(const RobustKernel& kernel, double squared_residual) {
  const double width2 = kernel.width * kernel.width;
  switch (kernel.shape) {
    case RobustKernel::Shape::huber: {
      if (squared_residual <= width2) return {squared_residual, 1.0};
      const double residual = std::sqrt(squared_residual);
      return {2.0 * kernel.width * residual - width2, kernel.width / residual};
    }
    case RobustKernel::Shape::cauchy: {
      const double ratio = squared_residual / width2;
      return {width2 * std::log1p(ratio), 1.0 / (1.0 + ratio)};
    }
    default:
      return {squared_residual, 1.0};
  }
}

}  // namespace helixnav::smoothing
