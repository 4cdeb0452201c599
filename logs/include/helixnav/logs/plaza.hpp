// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "helixnav/core/recording.hpp"

namespace helixnav::logs {

/// Noise of the Plaza robot. Odometry errors grow with the distance driven.
struct PlazaSettings {
  double sigma_distance_m_per_sqrt_m = 0.02;
  double sigma_sideways_m_per_sqrt_m = 0.02;
  double sigma_heading_rad_per_sqrt_m = 0.005;
  double range_scale =
      1.07;  ///< recorded range over true one; of Plaza 1 the same for each beacon and quarter to 0.001
  double sigma_range_m = 0.6;
  double empty_scan_after_s = 1.0;  ///< without a range: Plaza 1 has a gap of 97 s, driven in curves
};

/// Reads a CMU Plaza run (range-only beacons): comma-separated NAME_odometry.csv (t [s], distance [m], turn [rad]) and
/// NAME_ranges.csv (t [s], antenna, beacon, range [m]), and as truth, if they exist, NAME_groundtruth.csv (t [s], x
/// [m], y [m], heading) and NAME_beacons_true.csv (beacon, x [m], y [m]). `folder_or_odometry` is the folder when it
/// holds one run, else its NAME_odometry.csv. Each range is a Scan of one ObservationKind::range, labelled with its
/// beacon, and an empty scan marks where none came for a while; increments are split at the ranges in proportion to
/// time. Rows of ranges need not be in order (Plaza 1 has two blocks whose times overlap). The truth stays in its own
/// frame. Its headings are the integrated gyro, not a measurement, and are not passed on: true_positions only. Throws
/// core::InputError naming file:line. Test: logs/plaza_test.cpp.
core::Recording read_plaza(const std::filesystem::path& folder_or_odometry, const PlazaSettings& settings = {});

}  // namespace helixnav::logs
