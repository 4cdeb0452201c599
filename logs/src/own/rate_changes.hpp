// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"

namespace helixnav::logs {

/// How a vehicle's rates (speed ahead and to the left in m/s, turn rate in rad/s) have changed so far, and how far
/// apart its rows were: how uncertain a gap in them is. Rates are modelled as a random walk, whose variance per second
/// is the mean square of their changes over a second or more. It only knows the earlier rows, so that a stream and the
/// whole log give the same result. Test: logs/own/rate_changes_test.cpp.
class RateChanges {
 public:
  /// Rows in time order.
  void take(core::Nanoseconds t_ns, const Eigen::Vector3d& rates);

  /// Whether rows are missing in an interval that begins at the last one: longer than a second and than ten mean
  /// intervals. A log that has a row only when the speed changes has none.
  bool is_gap(core::Nanoseconds interval_ns) const;

  /// Variance of the rates' changes per second, (m/s)²/s and (rad/s)²/s. The vehicle is assumed to have started from
  /// rest within a second, turning by 0.1 rad/s, so that one that has always gone straight may turn, and one of
  /// constant speed may stop.
  Eigen::Vector3d variance_per_s() const;

 private:
  std::optional<core::Nanoseconds> first_ns_;
  core::Nanoseconds last_ns_ = 0;
  core::Nanoseconds since_ns_ = 0;                     ///< of the row that the next change is measured from
  Eigen::Vector3d since_ = Eigen::Vector3d::Zero();    ///< its rates
  Eigen::Vector3d squares_ = Eigen::Vector3d::Zero();  ///< of the changes
  double changing_s_ = 1.0;
  double intervals_ = 0.0;
};

}  // namespace helixnav::logs
