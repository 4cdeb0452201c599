// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "drive/drive.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {

/// Smooths a drive with the filter's own associations, from its poses and map, and adds path, figures and time to `run`.
/// Fixes are left out: the filter's gate has judged them, the smoother has none. The result in words. InputError or
/// NumericalError when the problem has no solution; `run` stays as it was.
std::string smooth(const Drive& job, runs::Run& run);

/// The same with the words on stdout; without a solution stderr says why, and the code tells.
ExitCode smooth_drive(const Drive& job, runs::Run& run);

}  // namespace helixnav::apps
