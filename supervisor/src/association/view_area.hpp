// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/events.hpp"

namespace helixnav::supervisor {

/// Area of the ground that a sensor with this view sees.
inline double view_area_m2(const core::FieldOfView& view) {
  return 0.5 * (view.max_bearing_rad - view.min_bearing_rad) *
         (view.max_range_m * view.max_range_m - view.min_range_m * view.min_range_m);
}

}  // namespace helixnav::supervisor
