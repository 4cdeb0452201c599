// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/logs/sick_scan.hpp"

namespace helixnav::logs {

/// What makes a run of beams count as a pole with retroreflective tape.
struct ReflectorRules {
  double max_range_m = 30.0;
  int max_gap_beams = 3;              ///< between successive bright beams of one pole
  std::uint8_t min_reflectivity = 1;  ///< code of the scanner, 1 … 4
  double pole_diameter_m = 0.06;      ///< range = mean of the surface ranges + half of this
};

/// Finds poles by the scanner's reflectivity code: runs of bright beams. Range and bearing are means over the beams of
/// the run. Ordered by bearing, from the right. Cost O(beams). Test: logs/detect_reflectors_test.cpp (equal to the
/// recorded detections of the ACFR car park).
std::vector<SickDetection> detect_reflectors(const SickScan& scan, const ReflectorRules& rules = {});

}  // namespace helixnav::logs
