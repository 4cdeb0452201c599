// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/logs/sick_scan.hpp"

namespace helixnav::logs {

/// What makes a run of beams count as a tree trunk. The defaults are the rules that ACFR published with the Victoria
/// Park log.
struct TreeRules {
  double max_range_m = 75.0;         ///< farther returns are ignored
  double min_range_m = 1.0;          ///< both ends of the trunk are at least this far away
  double max_range_jump_m = 1.5;     ///< between successive returns of one cluster
  double max_gap_beams = 10.0;       ///< likewise
  double isolation_m = 3.0;          ///< clusters closer than this to one of the `isolation_neighbours` next are bushes
  int isolation_neighbours = 3;      ///< how many clusters further on are compared
  double occlusion_gap_beams = 2.0;  ///< of two clusters closer than this in angle, the one behind is not whole
  double edge_margin_rad = 0.051333;  ///< 5π/306: nothing is accepted this close to the ends of the field of view
  double max_width_m = 1.0;           ///< between the first and the last return
  double max_skew = 1.0 / 3.0;        ///< range difference of first and last return, divided by the diameter
};

/// Finds tree trunks: clusters of returns that are isolated, not hidden, narrow and facing the sensor. Diameter = angle
/// covered (with half a beam on either side) × mean range of the two ends; range = middle return + half a diameter;
/// bearing = middle of the ends. Ordered by bearing, from the right. Cost O(beams); 5 µs per scan. Source: the detector
/// that ACFR distributed with Victoria Park, worked out from its published output. Test: logs/detect_trees_test.cpp
/// (equal to the published detections on all 7230 scans of the ASCII release).
std::vector<SickDetection> detect_trees(const SickScan& scan, const TreeRules& rules = {});

}  // namespace helixnav::logs
