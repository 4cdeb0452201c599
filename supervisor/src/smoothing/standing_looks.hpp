// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "helixnav/core/se2.hpp"
#include "loop/tape.hpp"

namespace helixnav::supervisor {

/// Leaves out of a drive what a stationary vehicle sees again and again: an hour at ten scans a second is 36 000 scans
/// of the same landmarks. At each place, the first 64 looks at each landmark are kept, which reduce white noise to an
/// eighth, and the last scan of every piece of the drive, so that the pose is known where the piece ends. Leaving out
/// measurements is conservative. Test: supervisor/smoothing/standing_looks_test.cpp.
class StandingLooks {
 public:
  /// The vehicle stands within a four-hundredth of this length and a fiftieth of a radian.
  explicit StandingLooks(double phase_m) : place_m_(phase_m / 400.0) {}

  /// The stops of the drive, piece by piece. O(stops · log landmarks at a place).
  void thin(std::vector<Stop>& stops);

 private:
  void move(const core::Pose2& T_before_after);
  void thin(Stop& stop);

  double place_m_;
  core::Pose2 T_place_here_;
  std::map<core::LandmarkId, int> looks_;  ///< from this place
};

}  // namespace helixnav::supervisor
