// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "helixnav/core/team_recording.hpp"

namespace helixnav::logs {

/// What the log does not state about its own noise. Derived in docs/team.md from residuals of run 9, whose robots have
/// no truth.
struct MrclamSettings {
  double sigma_range_m = 0.40;
  double sigma_bearing_rad = 0.05;
  double looks_as_one = 13.0;  ///< looks in a row that tell as much as one; both noises are those of all of them
  double sigma_speed_m_per_sqrt_s = 0.04;   ///< along, while commanded to move
  double sigma_side_m_per_sqrt_s = 0.01;    ///< across, likewise
  double sigma_turn_rad_per_sqrt_s = 0.10;  ///< heading, likewise
  double standing = 0.01;                   ///< of these, while commanded to stand
};

/// True for a folder of MRCLAM tables (measurements.csv, or odometry.csv and landmarks_true.csv; .gz or not: reporting
/// a missing rest is left to the reader), for one of the original files (Robot1_Odometry.dat …), and for an archive of
/// these.
bool is_mrclam(const std::filesystem::path& path);

/// Reads the robots selected by number (empty: all) from the UTIAS Multi-Robot Cooperative Localization and Mapping
/// data set: tables measurements.csv, odometry.csv, landmarks_true.csv and groundtruth.csv (the last two may be
/// missing; .gz or not), or the original .dat files in a folder or an archive. Velocity commands are held until the
/// next one and integrated on arcs, into increments that end at each sighting by or of the robot. A sighting with an
/// unknown subject (0, or a barcode that Barcodes.dat lacks) was misread: left out and counted. Each robot's truth and
/// start are in the Vicon frame; the start is the true pose at the first command. InputError, with file:line where
/// available: a file that is missing or garbled; a robot that does not exist, is requested twice, has its commands in
/// two places, has no sightings, or whose clock differs from the others'; a subject that is neither robot nor landmark.
/// Test: logs/mrclam_test.cpp.
core::TeamRecording read_mrclam(const std::filesystem::path& path, const std::vector<int>& robots = {},
                                const MrclamSettings& settings = {});

}  // namespace helixnav::logs
