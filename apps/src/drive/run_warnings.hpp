// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "drive.hpp"
#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {

/// Name of the run's number which says that a start given on an earlier map is one of several that fit.
constexpr const char* start_is_ambiguous = "start.ambiguous";

/// What a user should know about a completed run that is not to be trusted, as far as only the job explains it.
/// Test: apps/hostile/warnings_test.cpp.
std::vector<std::string> warnings_of_job(const Drive& job, const runs::Run& run);

/// Those of reports::warnings_of, and those of the job, which the run holds.
std::vector<std::string> warnings_of(const runs::Run& run, const evaluation::Evaluation& evaluation);

}  // namespace helixnav::apps
