// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/recording.hpp"

namespace helixnav::apps {

/// Takes true poses, and landmarks with them, out of the frame of the start into that of the fixes (true_positions), which is the map's
/// when these are fused. Poses and fixes were given in one frame where half of the fixes lie within four of their standard deviations (that
/// given, where they say none) of the true antenna; where they were not, nobody knows where the map lies in the frame of the truth, and the
/// two are aligned when they are compared. Test: apps/fusing_test.cpp.
void put_truth_in_frame_of_fixes(core::Recording& recording, double sigma_m);

}  // namespace helixnav::apps
