// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "slip/relative_geometry.hpp"

namespace helixnav::supervisor {

/// By how much the covariances that odometry and detector claim are too small, learnt from where matched landmarks are
/// seen. The innovation of three pairs or more falls into what a displacement of the vehicle explains (3 degrees of
/// freedom, wᵀw with w ~ N(0, I)) and the rest (2m − 3), which odometry has no part in: the rest says the detector's
/// factor, and what of w is odometry's share says odometry's. A mean of w over many scans is a bias (a wheel's radius, a
/// wrong scale of ranges) and no noise: it is left out, or DLR's forward motion, 8 % too long against its detector, would
/// pass for four times the variance. Never below 1. A value: it rolls back with the belief.
/// Test: supervisor/noise_scale_test.cpp.
class NoiseScale {
 public:
  /// One scan while nothing is in question; Q: the covariance of the motion before it (x, y, heading; robot frame).
  void observe(const PairEquations& pairs, const Eigen::Matrix3d& Q);

  double odometry() const { return odometry_; }          ///< factor on covariances
  double observations() const { return observations_; }  ///< factor on covariances

  /// What the whole drive was told with; 1 at its begin.
  double told_odometry = 1.0;
  double told_observations = 1.0;

 private:
  /// Exponentially fading sums; the scales that were applied to what they hold are in them.
  struct Window {
    double keep;
    double rest = 0.0, rest_dof = 0.0;
    double excess = 0.0, excess_weight = 0.0;

    double observations() const;
    double odometry() const;
  };

  void choose();

  Window slow_{1.0 - 1.0 / 300.0};
  Window quick_{1.0 - 1.0 / 60.0};
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();  ///< of w
  double mean_weight_ = 20.0;                       ///< so many scans of the belief that there is no bias
  double odometry_ = 1.0;
  double observations_ = 1.0;
};

}  // namespace helixnav::supervisor
