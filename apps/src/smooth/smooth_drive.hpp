// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "drive/drive.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {

/// Smooths a drive with the filter's own associations, from its poses and map, and adds path, figures and time to `run`.
/// Fixes are left out: the filter's gate has judged them, the smoother has none. When the problem has no solution, stderr
/// says why, `run` stays as it was, and the code tells.
ExitCode smooth_drive(const Drive& job, runs::Run& run);

}  // namespace helixnav::apps
