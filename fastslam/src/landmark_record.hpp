// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>

namespace helixnav::fastslam {

/// Name of a landmark across particles: all that were born from the same observation of the same scan share it.
using LineageId = std::uint32_t;

/// Symmetric 2×2 matrix.
struct Symmetric2 {
  double xx = 0.0, xy = 0.0, yy = 0.0;

  double trace() const { return xx + yy; }
  Eigen::Matrix2d matrix() const {
    Eigen::Matrix2d m;
    m << xx, xy, xy, yy;
    return m;
  }
};

/// A landmark as one particle knows it, in 32 bytes. The place is kept relative to the lineage's anchor, so that single
/// precision resolves it to 1e-7 of a few metres wherever the map is; the covariance as its Cholesky factor, which stays
/// positive definite whatever is rounded.
struct LandmarkRecord {
  float dx_m, dy_m;              ///< estimate minus anchor
  float l11_m, l21_m, l22_m;     ///< lower factor L of the covariance L·Lᵀ
  float log_odds;                ///< of its existence
  std::uint16_t last_hit_look;   ///< number of the look that counted last as seen, modulo 2^16
  std::uint16_t last_miss_look;  ///< and as not seen
  std::uint16_t hits;            ///< looks that saw it, birth included; stays at the largest number
  std::uint16_t mature;          ///< 0 or 1

  Symmetric2 covariance_m2() const {
    const double a = l11_m, b = l21_m, c = l22_m;
    return {a * a, a * b, b * b + c * c};
  }
  void set_covariance_m2(const Symmetric2& P) {
    const double a = std::sqrt(P.xx), b = P.xy / a;
    l11_m = static_cast<float>(a);
    l21_m = static_cast<float>(b);
    l22_m = static_cast<float>(std::sqrt(std::max(P.yy - b * b, 1e-12 * P.yy)));
  }
};
static_assert(sizeof(LandmarkRecord) == 32, "eight of these make a leaf of the map");

}  // namespace helixnav::fastslam
