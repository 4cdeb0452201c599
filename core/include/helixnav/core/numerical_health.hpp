// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::core {

/// How far the arithmetic of one step was from its limits, and where it failed. Filled from what is computed anyway: no
/// pass over the covariance of the map. Test: cekf/numerical_health_test.cpp, supervisor/numerical_health_test.cpp.
struct NumericalHealth {
  /// Least pivot of the Cholesky factors of innovation covariances S, each relative to the S_ii of which it is the
  /// remainder: the share of an innovation's variance that the rows before it do not predict. 1 without an update. As
  /// many digits of S are lost as this has zeros.
  double least_pivot = 1.0;
  double asymmetry = 0.0;  ///< largest |S_ij − S_ji| / √(S_ii·S_jj) before S is factored; 0 in exact arithmetic
  int repaired = 0;        ///< failed as asked, done in another way
  int refused = 0;         ///< failed and left undone, with everything as before

  /// Of both together.
  void note(const NumericalHealth& other) {
    if (other.least_pivot < least_pivot) least_pivot = other.least_pivot;
    if (other.asymmetry > asymmetry) asymmetry = other.asymmetry;
    repaired += other.repaired;
    refused += other.refused;
  }
};

/// Fewer than four digits of S are left to decide by, or half of its sixteen are rounding.
inline bool is_near_limit(const NumericalHealth& health) {
  constexpr double least_trusted_pivot = 1e-12;
  constexpr double most_trusted_asymmetry = 1e-8;
  return health.least_pivot < least_trusted_pivot || health.asymmetry > most_trusted_asymmetry;
}

}  // namespace helixnav::core
