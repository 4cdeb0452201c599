// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/recording.hpp"

namespace helixnav::apps {

struct GpsSettings {
  bool fuse = false;
  double sigma_m = 3.0;   ///< of one fix, in x and in y
  double start_m = 30.0;  ///< driven distance that aligns the start, unless less of it makes the heading sure
};

/// Makes AbsoluteFix events of the recording's true_positions, in order of time. The map frame becomes that of the GPS: the start
/// pose is aligned to the first fixes (align_start), until its heading is known to 2° or start_m are driven, and more
/// than half of the fixes agree (up to three times start_m). They are not fused again. Only true poses are used for the
/// evaluation if there are any, in that frame (put_truth_in_frame_of_fixes). InputError without GPS, or if the drive is
/// too short. Test: apps/fusing_test.cpp, apps/align_start_test.cpp.
void fuse_gps(core::Recording& recording, const GpsSettings& settings);

}  // namespace helixnav::apps
