// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/core/se2.hpp"

namespace helixnav::supervisor {

/// Poses of the sensor along the drive, close enough for their views to overlap, in the map frame as estimated at the time:
/// the ground that the drive has covered.
class CoverageTrace {
 public:
  explicit CoverageTrace(double spacing_m) : spacing_m_(spacing_m) {}
  void set_spacing(double spacing_m) { spacing_m_ = spacing_m; }

  /// Adds the sensor's pose when it is at least the spacing away from the last one.
  void pass(double path_m, const core::Pose2& T_world_sensor);

  /// Forgets what was passed after `path_m`.
  void back_to(double path_m);

  /// Everything so far was told in another frame.
  void change_frame(const core::Pose2& T_new_old);

  /// Sensor poses passed at path lengths in [from_m, to_m).
  std::vector<core::Pose2> between(double from_m, double to_m) const;

 private:
  struct Point {
    double path_m;
    core::Pose2 T_world_sensor;
  };
  double spacing_m_;
  std::vector<Point> points_;
};

}  // namespace helixnav::supervisor
