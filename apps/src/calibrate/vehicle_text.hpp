// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "calibration.hpp"
#include "helixnav/logs/vehicle.hpp"

namespace helixnav::apps {

/// The text of the vehicle's file with `noise_scale` in [odometry] and in every [[sensor]] multiplied by the factors found, and
/// with the constants that were kept; everything else, comments too, as it is. Test: apps/calibrate/calibrate_test.cpp.
std::string calibrated_text(const logs::Vehicle& vehicle, const Calibration& calibration);

}  // namespace helixnav::apps
