// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/angle.hpp"

namespace helixnav::reports {

inline double in_degrees(double angle_rad) { return angle_rad * 180.0 / core::pi; }

}  // namespace helixnav::reports
