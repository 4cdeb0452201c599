// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::sim {

/// Where a sensor sees a point.
struct Polar {
  double range_m = 0.0;
  double bearing_rad = 0.0;
};

inline Polar polar(const core::Pose2& T_sensor_world, const Eigen::Vector2d& point_world_m) {
  const Eigen::Vector2d point_m = core::transform(T_sensor_world, point_world_m);
  return {point_m.norm(), std::atan2(point_m.y(), point_m.x())};
}

inline bool contains(const core::FieldOfView& view, const Polar& point) {
  return view.min_range_m <= point.range_m && point.range_m <= view.max_range_m &&
         view.min_bearing_rad <= point.bearing_rad && point.bearing_rad <= view.max_bearing_rad;
}

}  // namespace helixnav::sim
