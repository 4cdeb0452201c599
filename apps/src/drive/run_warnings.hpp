// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "drive.hpp"
#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {

/// What a user should know of a run that came to its end and is not to be trusted: what reports::warnings_of says, and
/// what only the job explains. Test: apps/hostile/warnings_test.cpp.
std::vector<std::string> warnings_of(const Drive& job, const runs::Run& run, const evaluation::Evaluation& evaluation);

}  // namespace helixnav::apps
