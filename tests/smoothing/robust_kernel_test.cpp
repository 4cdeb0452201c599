// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/robust_kernel.hpp"

#include <gtest/gtest.h>

namespace helixnav::smoothing {
namespace {

class RobustKernelOf : public ::testing::TestWithParam<RobustKernel::Shape> {};

TEST_P(RobustKernelOf, HasItsDerivativeAsWeight) {
  const RobustKernel kernel{GetParam(), 1.7};
  for (const double s : {0.1, 1.0, 2.5, 4.0, 30.0, 1e4}) {
    const double h = 1e-5 * s;
    const double difference = (evaluate(kernel, s + h).cost - evaluate(kernel, s - h).cost) / (2.0 * h);
    EXPECT_NEAR(evaluate(kernel, s).weight, difference, 1e-7) << "s = " << s;
  }
}

TEST_P(RobustKernelOf, LeavesSmallResidualsAsSquares) {
  const RobustKernel kernel{GetParam(), 1.7};
  EXPECT_NEAR(evaluate(kernel, 1e-6).cost, 1e-6, 1e-11);
}

TEST_P(RobustKernelOf, NeverExceedsTheSquare) {
  const RobustKernel kernel{GetParam(), 1.7};
  for (const double s : {0.0, 1.0, 10.0, 1000.0}) EXPECT_LE(evaluate(kernel, s).cost, s);
}

INSTANTIATE_TEST_SUITE_P(Shapes, RobustKernelOf,
                         ::testing::Values(RobustKernel::Shape::none, RobustKernel::Shape::huber,
                                           RobustKernel::Shape::cauchy));

}  // namespace
}  // namespace helixnav::smoothing
