// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/se2.hpp"
#include "slip/relative_geometry.hpp"

namespace helixnav::supervisor {

/// How well a map falls on itself when it is displaced. Where one place of the vehicle has observations on known
/// landmarks, another may have them on new ones; and a new landmark is where the pattern of the known ones continues,
/// which in a lattice displaced by a pitch is where the other place needs it. Built once for a pair of places, O(n²) in
/// the landmarks. Test: supervisor/slip/density_by_pattern_test.cpp.
class DensityByPattern {
 public:
  /// `T_other_one`: takes a landmark from where it is to where the other place sees what the first takes for it.
  DensityByPattern(const RelativeGeometry& geometry, const core::Pose2& T_other_one);

  /// Density [1/m²] with which the pattern has a landmark where an observation of this covariance [m²] needs one: the
  /// mean, over the landmarks displaced onto mapped ground, of the density of the difference to the nearest other
  /// landmark there. The prior is two more that fell on nothing. O(n).
  double per_m2(const Eigen::Matrix2d& seen_covariance_m2) const;

 private:
  struct Difference {
    Eigen::Vector2d difference_m;
    Eigen::Matrix2d covariance_m2;
  };
  std::vector<Difference> differences_;
};

}  // namespace helixnav::supervisor
