// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace helixnav::core {

inline constexpr double pi = 3.14159265358979323846;

/// The equivalent of `angle_rad` in (-π, π]. NaN and infinities give NaN.
/// Test: core/angle_test.cpp.
inline double wrap_to_pi(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2.0 * pi);
  return wrapped <= -pi ? pi : wrapped;
}

}  // namespace helixnav::core
