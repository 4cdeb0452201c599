// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "helixnav/core/time.hpp"

namespace helixnav::logs {

/// One turn of a SICK LMS scanner in its 180° mode, as it left the device: beam k looks at k·0.5° − 90° in the sensor's
/// frame (counter-clockwise from straight ahead), so beam 0 looks to the right and beam 360 to the left.
struct SickScan {
  static constexpr int beams = 361;

  core::Nanoseconds t_ns = 0;
  std::array<std::uint16_t, beams> range_cm{};     ///< 8183 … 8191: no return, dazzled or other error codes
  std::array<std::uint8_t, beams> reflectivity{};  ///< 0 (ordinary) … 4 (retroreflector); 0 where not recorded
};

/// Something round and upright seen in one scan, in the sensor's frame.
struct SickDetection {
  double range_m = 0.0;      ///< to the centre, not the surface
  double bearing_rad = 0.0;  ///< counter-clockwise from straight ahead
  double diameter_m = 0.0;
  int beams_hit = 0;  ///< number of returns that it consists of
};

}  // namespace helixnav::logs
