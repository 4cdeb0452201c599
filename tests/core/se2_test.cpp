// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/se2.hpp"

#include <gtest/gtest.h>

namespace helixnav::core {
namespace {
TEST(Se2, ComposeWithInverseIsIdentity) {
  const Pose2 T(1.0, -2.0, 3.1);
  EXPECT_NEAR(compose(T, inverse(T)).vector().norm(), 0.0, 1e-12);
}
}  // namespace
}  // namespace helixnav::core
