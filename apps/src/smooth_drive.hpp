// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "drive.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/logs/run_writer.hpp"

namespace helixnav::apps {

/// Smooths a drive whose steps stand in job.out, with the filter's own associations, from its poses and `map`, and puts
/// path, figures and time into `end`. Fixes are left out: the filter's gate has judged them, the smoother has none. When
/// the problem has no solution, stderr says why, `end` stays as it was, and the code tells.
ExitCode smooth_drive(const Drive& job, const std::vector<core::MapLandmark>& map, logs::RunEnd& end);

}  // namespace helixnav::apps
