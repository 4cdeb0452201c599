// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "calibration.hpp"
#include "helixnav/logs/vehicle.hpp"

namespace helixnav::apps {

/// The text of the vehicle file with `noise_scale` in [odometry] and in every [[sensor]] multiplied by the estimated factors,
/// and with the constants that were kept; everything else, including comments, is unchanged. Test:
/// apps/calibrate/calibrate_test.cpp.
std::string calibrated_text(const logs::Vehicle& vehicle, const Calibration& calibration);

}  // namespace helixnav::apps
