// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/runs/run.hpp"
#include "json.hpp"

namespace helixnav::reports {

/// The landmarks of a drive as known at each step, packed: per landmark "id", "until" (step from which it was gone; -1: it
/// stayed), "count" of its places, and for each place "step" from which it holds, "x", "y", "state", ellipse.
Json player_landmarks(const runs::Run& run);

}  // namespace helixnav::reports
