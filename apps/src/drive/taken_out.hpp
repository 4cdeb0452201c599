// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/recording.hpp"
#include "helixnav/runs/run.hpp"
#include "helixnav/supervisor/systematic_errors.hpp"

namespace helixnav::apps {

/// What a run has taken out of its odometry and detections by its end.
supervisor::SystematicErrors taken_out_of(const runs::Run& run);

/// The recording without it: what least squares and the statistics of a run are to start from.
/// Test: apps/systematic_errors_test.cpp.
core::Recording without_taken_out(const runs::Run& run, core::Recording recording);

}  // namespace helixnav::apps
