// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/recording.hpp"

namespace helixnav::apps {

/// Transforms true poses, and landmarks with them, from the frame of the start into that of the fixes (true_positions), which is the map's
/// when these are fused. Poses and fixes were given in one frame if half of the fixes are within four of their standard deviations (the
/// given one, if they state none) of the true antenna; if not, nobody knows the map frame in the frame of the truth, and the two are
/// aligned for comparison. Test: apps/fusing_test.cpp.
void put_truth_in_frame_of_fixes(core::Recording& recording, double sigma_m);

}  // namespace helixnav::apps
