// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/recording.hpp"
#include "helixnav/core/time.hpp"
#include "helixnav/logs/sick_scan.hpp"

namespace helixnav::logs {

/// One reading of the truck's rear-left wheel encoder and steering sensor, 40 per second.
struct DeadReckoning {
  core::Nanoseconds t_ns = 0;
  double wheel_speed_mps = 0.0;  ///< of the wheel, not of the centre of the axle
  double steering_rad = 0.0;     ///< positive to the left
};

/// One GPS fix in a local frame, x east and y north.
struct GpsFix {
  core::Nanoseconds t_ns = 0;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
};

/// A log of the ACFR truck (Victoria Park, car park) as recorded, before any model. Each sensor's readings are in time
/// order (times of one sensor never decrease).
struct AcfrLog {
  std::string name;
  std::vector<DeadReckoning> dead_reckoning;
  std::vector<SickScan> scans;
  std::vector<GpsFix> gps;
  std::vector<core::TrueLandmark> beacons;  ///< surveyed, in the frame of the GPS; label = row in the file

  /// In the order of the codes 1, 2, 3 in ACFR's event tables.
  enum class Sensor { gps, dead_reckoning, laser };
  struct Reading {
    Sensor sensor = Sensor::gps;
    std::size_t index = 0;
  };
  std::vector<Reading> order;  ///< all readings in the order they arrived
};

/// Reads ACFR's text release: a folder or a zip that holds DRS.txt, LASER.txt, GPS.txt and Sensors_manager.txt (at any
/// depth in the zip). Seconds and metres in the files; LASER.txt is one line without line breaks. Victoria Park: 0.6 s.
/// Throws core::InputError with file and line (LASER.txt: byte) for a missing or broken file, an invalid number, time
/// going backwards, or an index or time in Sensors_manager.txt that the other files do not have. Test:
/// logs/acfr_ascii_test.cpp.
AcfrLog read_acfr_ascii(const std::filesystem::path& folder_or_zip);

/// Reads Victoria Park from its MATLAB files in one folder: aa3_dr.mat and aa3_gpsx.mat; scans from aa3_lsr2.mat, else
/// from LASER.txt, else from the one in victoria_park_ascii.zip, else none. Times are shifted to the clock of the text
/// release, which starts 20.967 s later, at the first GPS fix, so that results and GPS of the two can be compared. The
/// steering differs from the text release's (data README). Errors as read_acfr_ascii. Test: logs/acfr_mat_test.cpp.
AcfrLog read_victoria_park_mat(const std::filesystem::path& folder);

/// All 4466 fixes of Victoria Park from aa3_gpsx.mat, on the clock of the text release, which has only 948 of them.
std::vector<GpsFix> read_victoria_park_gps(const std::filesystem::path& aa3_gpsx);

/// Reads the ACFR car park: data_set.mat and, if present, the surveyed poles from beac_juan3.mat beside it. Errors as
/// read_acfr_ascii. Test: logs/acfr_mat_test.cpp.
AcfrLog read_car_park_mat(const std::filesystem::path& data_set);

}  // namespace helixnav::logs
