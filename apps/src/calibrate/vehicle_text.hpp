// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/logs/vehicle.hpp"
#include "helixnav/smoothing/noise_scales.hpp"

namespace helixnav::apps {

/// The text of the vehicle's file with `noise_scale` in [odometry] and in every [[sensor]] multiplied by the factors found;
/// everything else, comments too, as it is. Test: apps/calibrate_test.cpp.
std::string with_noise_scales(const logs::Vehicle& vehicle, const smoothing::NoiseScales& scales);

}  // namespace helixnav::apps
