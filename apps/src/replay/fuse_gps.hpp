// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/recording.hpp"

namespace helixnav::apps {

struct GpsSettings {
  bool fuse = false;
  double sigma_m = 3.0;   ///< of one fix, in x and in y
  double start_m = 30.0;  ///< driven distance that aligns the start with the GPS frame
};

/// Makes AbsoluteFix events of the recording's true_positions, in order of time. The map frame becomes that of the GPS: the start pose
/// is the rigid alignment of the dead-reckoned path to the fixes over the first start_m metres, with the covariance of that
/// least-squares fit as if only two of those fixes were independent. They are not fused again. Only true poses are used for the
/// evaluation if there are any, in that frame (put_truth_in_frame_of_fixes). InputError without GPS, or if the drive is too short.
/// Test: apps/fusing_test.cpp.
void fuse_gps(core::Recording& recording, const GpsSettings& settings);

}  // namespace helixnav::apps
