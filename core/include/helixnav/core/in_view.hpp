// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/events.hpp"

namespace helixnav::core {

/// Whether the view looks all around.
inline bool is_all_around(const FieldOfView& view) {
  return view.max_bearing_rad - view.min_bearing_rad >= 2.0 * pi - 1e-6;
}

/// Whether a bearing, in the sensor frame [rad], is between those of the view, narrowed by margin_rad at both ends;
/// any for a view all around. The view's own bearings may be beyond ±π: from 90° to 270° is across the back.
/// Test: core/in_view_test.cpp.
inline bool is_between_bearings(const FieldOfView& view, double bearing_rad, double margin_rad = 0.0) {
  if (is_all_around(view)) return true;
  const double middle_rad = 0.5 * (view.min_bearing_rad + view.max_bearing_rad);
  const double half_rad = 0.5 * (view.max_bearing_rad - view.min_bearing_rad);
  return std::abs(wrap_to_pi(bearing_rad - middle_rad)) <= half_rad - margin_rad;
}

}  // namespace helixnav::core
