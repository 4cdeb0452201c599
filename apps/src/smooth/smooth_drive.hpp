// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "drive/drive.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {

/// Smooths a drive with the filter's own associations, from its poses and map, and adds path, figures and time to `run`.
/// Fixes are left out: the filter's gate has judged them, the smoother has none. The result in words. InputError or
/// NumericalError if the problem has no solution; `run` stays as it was.
std::string smooth(const Drive& job, runs::Run& run);

/// The same with the text on stdout; without a solution the reason is on stderr, and the exit code reports it.
ExitCode smooth_drive(const Drive& job, runs::Run& run);

}  // namespace helixnav::apps
