// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/core/recording.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::runs {

/// Writes the truth_*.csv files for which the recording has content.
void write_truth(const std::string& folder, const core::Recording& recording);

/// Adds the pose of map.csv to truth_frame.csv when the run ended in a part of the drive that was not found on the
/// earlier map: in another frame than the truth. Nothing otherwise.
void write_frame_of_map(const std::string& folder, const Run& run);

}  // namespace helixnav::runs
