// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::logs {

/// What a truck can do; beyond it a file is garbage. The vehicle model has a pole at a steering of 1.31 rad.
inline constexpr double most_speed_mps = 100.0;
inline constexpr double most_steering_rad = 1.2;

}  // namespace helixnav::logs
