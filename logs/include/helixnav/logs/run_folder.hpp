// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/logs/run_manifest.hpp"

namespace helixnav::logs {

/// What is known from elsewhere about a run; any part may be empty.
struct RunTruth {
  std::vector<core::TruePose> poses;          ///< of the reference point, in the map frame
  std::vector<core::TruePosition> positions;  ///< of the antenna, in a frame of their own
  Eigen::Vector2d antenna_robot_m = Eigen::Vector2d::Zero();
  std::vector<core::TrueLandmark> landmarks;     ///< in the frame of the poses, or of the positions if there are any
  std::vector<std::vector<core::Label>> labels;  ///< [step][observation]
};

/// A run folder in memory: what RunWriter was told.
struct RunFolder {
  std::string path;
  RunManifest manifest;
  std::vector<core::StepReport> steps;  ///< in order of time; revisions applied; only the clouds that were kept
  std::vector<double> microseconds;     ///< [step] wall clock
  std::vector<core::MapLandmark> map;   ///< empty unless the run came to its end
  RunTruth truth;
  bool finished = false;  ///< the run came to its end
};

/// Reads a run folder, also one whose run was killed: an incomplete last line of a table is dropped, and so is a step
/// of which any part is missing. InputError (file:line, what was expected) for anything else that is wrong, such as a
/// folder without manifest.json. Cost: about 0.1 s for 7000 steps with 50 000 associations.
/// Test: logs/run_folder_test.cpp (tables cut at every kind of byte).
RunFolder read_run(const std::string& path);

/// Reads a map.csv. InputError naming file:line. Test: logs/run_folder_test.cpp.
std::vector<core::MapLandmark> read_map(const std::string& path);

/// Reads truth from a folder (truth_*.csv, those that exist) or from one such file, recognised by its header line.
/// InputError when there is none.
RunTruth read_truth(const std::string& path);

}  // namespace helixnav::logs
