// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/observation.hpp"
#include "helixnav/core/se2.hpp"
#include "helixnav/core/time.hpp"

namespace helixnav::core {

/// Motion since the previous odometry event, in the frame of the robot before it moved, with its full 3×3 covariance in
/// (x, y, heading) [m, m, rad]. Estimators know no other kind of motion.
struct Odometry {
  Nanoseconds t_ns = 0;  ///< end of the increment
  Pose2 T_before_after;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Where the sensor can see a landmark: the region that "seen" and "should have been seen" refer to.
struct FieldOfView {
  double min_range_m = 0.0;
  double max_range_m = std::numeric_limits<double>::infinity();
  double min_bearing_rad = -pi;  ///< in the sensor frame, counter-clockwise
  double max_bearing_rad = pi;
  double reach_m = 0.0;  ///< landmarks are seen up to here, if not as reliably; 0: up to max_range_m

  /// How far the sensor sees landmarks at all: what lengths are measured by (supervisor/lengths.hpp). Nothing when the
  /// log or the sensor does not say (max_range_m 0 or infinite).
  std::optional<double> reach() const {
    const double reach = reach_m > 0.0 ? reach_m : max_range_m;
    if (!(reach > 0.0 && std::isfinite(reach))) return std::nullopt;
    return reach;
  }
};

/// The observations of one instant by one sensor. May be empty: "nothing was seen" is information.
struct Scan {
  Nanoseconds t_ns = 0;
  Pose2 T_robot_sensor;
  FieldOfView field_of_view;
  std::vector<Observation> observations;
};

/// An absolute position in the map frame, as by GPS, of a point on the robot (the antenna).
struct AbsoluteFix {
  Nanoseconds t_ns = 0;
  Eigen::Vector2d position_world_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Identity();
  Eigen::Vector2d antenna_robot_m = Eigen::Vector2d::Zero();
};

/// Since the event before, the vehicle was moved by something other than its wheels, and nobody measured how: where it
/// is now is unknown.
struct Lost {
  Nanoseconds t_ns = 0;
};

/// Everything that may enter an estimator. Labels and truth travel alongside events (core/recording.hpp), never inside.
using Event = std::variant<Odometry, Scan, AbsoluteFix, Lost>;

inline Nanoseconds time_of(const Event& event) {
  return std::visit([](const auto& e) { return e.t_ns; }, event);
}

}  // namespace helixnav::core
