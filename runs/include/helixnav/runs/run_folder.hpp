// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/runs/run.hpp"

namespace helixnav::runs {

/// Reads a run folder, also of a run that was killed: an incomplete last line of a table is dropped, and so is a step
/// with any part missing. If a completed run has lost rows since, `missing` reports this. InputError (file:line, what
/// was expected) for anything else that is wrong, such as a folder without manifest.json. Cost: about 0.1 s for 7000
/// steps with 50 000 associations. Test: runs/run_folder_test.cpp (tables cut at every kind of byte).
Run read_run(const std::string& path);

/// Reads the manifest.json of a run folder. InputError if it is missing or cannot be used.
RunManifest read_manifest(const std::string& path);

/// Reads a map.csv. InputError naming file:line. Test: runs/run_folder_test.cpp.
std::vector<core::MapLandmark> read_map(const std::string& path);

/// The landmark names in a map.csv; empty if they have none. Errors as read_map.
std::map<core::LandmarkId, std::string> read_landmark_names(const std::string& path);

/// Reads truth from a folder (those truth_*.csv that exist) or from one such file, recognised by its header line.
/// InputError when there is none.
RunTruth read_truth(const std::string& path);

}  // namespace helixnav::runs
