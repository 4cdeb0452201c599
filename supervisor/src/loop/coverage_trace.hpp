// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
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

  /// Forgets what was passed until `path_m`.
  void begin_after(double path_m);

  /// Of the poses passed before `path_m`, drops those that saw nothing that an older one did not see: less than three
  /// quarters of the spacing away from it and turned by less than 0.3 rad. Those with `needed(path_m)` are kept. Does
  /// nothing until there are twice as many poses as it last left, and never below 4096, so that it costs O(log n) per pose
  /// and the number of poses grows with the ground covered, however long the drive. Throws only std::bad_alloc, with
  /// nothing changed.
  /// Test: supervisor/coverage_trace_test.cpp.
  void thin_before(double path_m, const std::function<bool(double)>& needed);
  std::size_t size() const { return points_.size(); }

  /// Moves everything so far into a new frame.
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
  std::size_t thin_from_ = 4096;  ///< points
};

}  // namespace helixnav::supervisor
