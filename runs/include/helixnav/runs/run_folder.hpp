// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/runs/run.hpp"

namespace helixnav::runs {

/// Reads a run folder, also one whose run was killed: an incomplete last line of a table is dropped, and so is a step
/// of which any part is missing. Where a run that came to its end has lost rows since, `missing` says so. InputError (file:line, what was expected) for anything else that is wrong, such as a
/// folder without manifest.json. Cost: about 0.1 s for 7000 steps with 50 000 associations.
/// Test: runs/run_folder_test.cpp (tables cut at every kind of byte).
Run read_run(const std::string& path);

/// Reads the manifest.json of a run folder. InputError where there is none or it cannot be used.
RunManifest read_manifest(const std::string& path);

/// Reads a map.csv. InputError naming file:line. Test: runs/run_folder_test.cpp.
std::vector<core::MapLandmark> read_map(const std::string& path);

/// What a map.csv says its landmarks are called; empty where they have no names. Errors as read_map.
std::map<core::LandmarkId, std::string> read_landmark_names(const std::string& path);

/// Reads truth from a folder (truth_*.csv, those that exist) or from one such file, recognised by its header line.
/// InputError when there is none.
RunTruth read_truth(const std::string& path);

}  // namespace helixnav::runs
