// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/logs/own_log.hpp"
#include "rate_changes.hpp"

namespace helixnav::logs {

/// Motion at a constant twist over a span of time, in the frame that odometry is measured in.
struct Motion {
  core::Nanoseconds begin_ns = 0, end_ns = 0;
  Eigen::Vector3d twist = Eigen::Vector3d::Zero();  ///< (x, y, heading) whose exponential is the increment
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// If rows are missing: variance of the changes of (speed ahead, to the left, turn rate) per second, (m/s)²/s and
  /// (rad/s)²/s.
  Eigen::Vector3d rate_walk = Eigen::Vector3d::Zero();

  /// Whether speeds are held through a gap in which they may have changed.
  bool may_change() const { return !rate_walk.isZero(0.0); }
};

/// The increment of a twist: an arc. Test: logs/own/own_recording_test.cpp (against fine integration).
core::Pose2 exponential(const Eigen::Vector3d& twist);
/// Its inverse for turns within ±2π.
Eigen::Vector3d logarithm(const Eigen::Vector3d& increment);

/// The motions that the rows of a log describe, for a vehicle. Throws core::InputError when the vehicle lacks what the
/// kind of odometry needs, or the noise.
class Motions {
 public:
  Motions(const OwnLog& log, const Vehicle& vehicle);

  /// The motion of a row: up to it (increments, poses) or from it to the next (the others; the last until `last_ns`).
  /// The first increment is taken to have lasted as long as the second. Nothing for the first pose. A row of speeds
  /// that reports standing still, and is held through a gap (of more than a second and ten times the interval before
  /// it), is as uncertain as if it had been held for that interval: errors that occur at speed do not add up while
  /// nothing moves. If it reports driving and is held through a gap (RateChanges::is_gap), the rates may change meanwhile
  /// as they did in the rows up to it. Rows must be requested in order; one may be requested again.
  std::optional<Motion> of_row(std::size_t row, core::Nanoseconds last_ns);

  /// Beyond the last row of increments or poses, which was requested before: its rates are held, and may change as they did in the
  /// rows up to it. Nothing if it has no duration.
  std::optional<Motion> beyond_last() const;

  /// Whether a row describes what comes after it.
  bool holds() const;

  /// The first rows of the log were removed from it, all of them requested before.
  void forget(std::size_t rows) { taken_ -= std::min(taken_, rows); }

 private:
  void take_held_rates(std::size_t row);
  void take_mean_rates(std::size_t row, const Motion& motion);
  core::Nanoseconds first_begin_ns() const;
  Motion stretch(std::size_t row, core::Nanoseconds last_ns) const;
  std::optional<core::Nanoseconds> stands_through_gap(std::size_t row, const Motion& motion) const;
  void move(Motion& motion, std::size_t row) const;
  void add_model_noise(Motion& motion) const;
  Eigen::Matrix3d sample_noise() const;
  void add_sample_noise(Motion& motion, std::size_t row) const;
  Eigen::Vector3d steered(Motion& motion, const Eigen::Vector3d& value) const;

  const OwnLog& log_;
  const OdometryModel& model_;
  RateChanges changes_;
  std::optional<Motion> last_;  ///< that was requested
  std::size_t taken_ = 0;       ///< rows that changes_ has taken
};

/// A part of a motion as an increment of the vehicle. If rates may change, s seconds into the gap, the error of a
/// heading grows by rate_walk·s² per second: the variance of a heading at s is then that of a random walk of the turn
/// rate, rate_walk·s³/3, however often scans divide the gap; likewise for distance. Test: logs/own/own_gap_test.cpp.
core::Odometry part_of(const Motion& motion, core::Nanoseconds from_ns, core::Nanoseconds to_ns,
                       const core::Pose2& T_vehicle_odometry);

}  // namespace helixnav::logs
