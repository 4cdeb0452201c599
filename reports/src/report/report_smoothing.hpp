// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/runs/smoothed_run.hpp"
#include "json.hpp"

namespace helixnav::reports {

/// The smoothing section of the report: path and maps, χ² by iteration, residuals; lines thinned.
Json smoothing_data(const runs::SmoothedRun& smoothed);

}  // namespace helixnav::reports
