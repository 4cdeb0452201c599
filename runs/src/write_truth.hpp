// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/core/recording.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::runs {

/// Writes the truth_*.csv that the recording has something for.
void write_truth(const std::string& folder, const core::Recording& recording);

/// Adds to truth_frame.csv where map.csv lies when the run ended in a part of the drive that was not found on the map of before: in
/// another frame than the truth. Nothing otherwise.
void write_frame_of_map(const std::string& folder, const Run& run);

}  // namespace helixnav::runs
