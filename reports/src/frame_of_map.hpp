// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// Whether the run had an earlier map to go on in, or to be localised on.
bool has_earlier_map(const runs::Run& run);

/// Which frame the map of a run lies in: "fixes" (that of fused position fixes), "earlier" (that of the earlier map, once the place on
/// it is known) or "start" (the pose at the start). Test: reports/report_test.cpp.
const char* frame_of_map(const runs::Run& run);

}  // namespace helixnav::reports
