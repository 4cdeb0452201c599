// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/runs/run_folder.hpp"

namespace helixnav::apps {

/// Truth from outside the run folder: all GPS fixes of Victoria Park (aa3_gpsx.mat, on the clock of the text
/// release; the lever arm is the run's), a truth_*.csv or a folder of them. `offset_s` is added to every time.
/// InputError with file:line for anything else.
runs::RunTruth read_truth_file(const std::string& path, double offset_s, const runs::RunTruth& run);

}  // namespace helixnav::apps
