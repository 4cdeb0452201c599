// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "helixnav/core/recording.hpp"
#include "helixnav/logs/acfr_recording.hpp"
#include "helixnav/logs/dlr.hpp"
#include "helixnav/logs/mrclam.hpp"
#include "helixnav/logs/plaza.hpp"
#include "helixnav/logs/pose_landmark_text.hpp"
#include "helixnav/logs/vehicle.hpp"

namespace helixnav::logs {

/// Published formats that replay knows.
enum class LogFormat {
  acfr_ascii,          ///< folder or archive with DRS.txt and LASER.txt
  victoria_park_mat,   ///< folder with aa3_dr.mat
  car_park_mat,        ///< folder with data_set.mat, or a MATLAB file with Laser and Intensity
  pose_landmark_text,  ///< text whose first keyword is ODOMETRY or LANDMARK with numbers (iSAM, GTSAM)
  g2o,                 ///< text whose first keyword is a VERTEX_… or EDGE_…
  slsjf_mat,           ///< MATLAB file with VicPark_clean_data
  dlr,                 ///< text whose first keyword is STEP, LANDMARK_C or LANDMARK_L
  plaza,               ///< folder with one …_odometry.csv and …_ranges.csv, or that odometry file
  own,                 ///< the user's own: a folder with odometry.csv and detections.csv, or JSON Lines
};
std::string_view name_of(LogFormat format);

/// Detects the format from the content, never from the name of the file given. Throws core::InputError for a path that
/// does not exist, and for an unknown format, naming everything that was looked for. Test:
/// logs/read_recording_test.cpp.
LogFormat recognise(const std::filesystem::path& path);

/// One set of settings for each family of logs.
struct RecordingSettings {
  AcfrSettings victoria_park;
  AcfrSettings car_park = car_park_settings();
  PlazaSettings plaza;
  NoiseColumns noise_columns = NoiseColumns::recognise;
  DlrOptions dlr;
  MrclamSettings mrclam;           ///< for logs of several robots (read_mrclam)
  std::optional<Vehicle> vehicle;  ///< for a log of the user's own; nothing: the vehicle.toml beside it
};

/// Detects the format and reads. Errors are core::InputError, and nothing else.
core::Recording read_recording(const std::filesystem::path& path, const RecordingSettings& settings = {});

}  // namespace helixnav::logs
