// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/supervisor/odometry_rhythm.hpp"

namespace helixnav::supervisor {

/// By how much odometry and detections err throughout a drive. Noise has mean zero; these do not.
struct SystematicErrors {
  static constexpr int count = 5;
  using Vector = Eigen::Matrix<double, count, 1>;
  using Matrix = Eigen::Matrix<double, count, count>;

  double too_long = 0.0;        ///< of odometry's distances, as a share of the true ones; negative: too short
  double turn_rad_per_s = 0.0;  ///< by which odometry turns too far to the left
  double turn_rad_per_m = 0.0;  ///< likewise, per metre forwards
  double heading_rad = 0.0;     ///< by which all sensors point farther to the left than stated
  double short_m = 0.0;         ///< missing from every range

  SystematicErrors() = default;
  explicit SystematicErrors(const Vector& v)
      : too_long(v(0)), turn_rad_per_s(v(1)), turn_rad_per_m(v(2)), heading_rad(v(3)), short_m(v(4)) {}

  Vector vector() const {
    return (Vector() << too_long, turn_rad_per_s, turn_rad_per_m, heading_rad, short_m).finished();
  }
  bool are_zero() const { return vector().isZero(0.0); }
};

/// The errors of what has `first`, and after that was taken out, `then`.
SystematicErrors both(const SystematicErrors& first, const SystematicErrors& then);

/// A motion measured over this time, and a scan, with the errors taken out. A turn bias per second is taken out of half of the
/// time in which odometry was silent, and the other half is a standard deviation: right whether the gyro ran on or not.
/// Test: supervisor/systematic/systematic_errors_test.cpp.
core::Odometry without(const SystematicErrors& errors, const core::Odometry& measured, const TimeMoved& time);
core::Scan without(const SystematicErrors& errors, core::Scan measured);

/// Derivatives at no errors of a motion (x, y, heading) and of an observation of two rows with the errors taken out; those of an
/// observation are of its innovation, since a mounting changes what is predicted. Test: as above (central differences).
Eigen::Matrix<double, 3, SystematicErrors::count> derivative_without_errors(const core::Pose2& T_before_after,
                                                                            double seconds);
Eigen::Matrix<double, 2, SystematicErrors::count> derivative_without_errors(const core::Observation& observation);

}  // namespace helixnav::supervisor
