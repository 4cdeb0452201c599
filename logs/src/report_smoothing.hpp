// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/logs/smoothed_run.hpp"
#include "run_json.hpp"

namespace helixnav::logs {

/// The smoothing section of the report: path and maps, χ² by iteration, residuals; lines thinned.
Json smoothing_data(const SmoothedRun& smoothed);

}  // namespace helixnav::logs
