// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <Eigen/Core>

namespace helixnav::supervisor {

/// The slips of the drive so far. A vehicle that has slipped before may slip again, even if nothing is in view that
/// would show it: then the motion is as uncertain as slips at the rate and of the size seen so far make it.
/// Test: supervisor/slip/slip_decision_test.cpp.
struct SlipRecord {
  int count = 0;
  double sum_m2 = 0.0;     ///< of squared displacements
  double sum_rad2 = 0.0;   ///< of squared turns
  double watched_m = 0.0;  ///< driven where a slip would have been seen
  bool blind = false;      ///< the last scan matched too little to show one

  void add(const Eigen::Vector3d& displacement) {
    ++count;
    sum_m2 += displacement.head<2>().squaredNorm();
    sum_rad2 += displacement.z() * displacement.z();
  }

  /// After each scan.
  void see(std::size_t matched) {
    constexpr std::size_t enough = 3;
    blind = matched < enough;
  }

  /// Covariance of the slips to be expected on a drive: zero while slips are seen, or before there were two of them.
  /// `least_m`: over a shorter drive nobody knows their rate.
  Eigen::Matrix3d drive(double driven_m, double least_m) {
    constexpr int enough = 2;
    if (!blind) watched_m += driven_m;
    if (!blind || count < enough) return Eigen::Matrix3d::Zero();
    const double share = driven_m / std::max(least_m, watched_m);
    return Eigen::Vector3d(0.5 * share * sum_m2, 0.5 * share * sum_m2, share * sum_rad2).asDiagonal();
  }
};

}  // namespace helixnav::supervisor
