// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/recording.hpp"

namespace helixnav::sim {

/// The simulation of ihgr_zhang2005 §IV.A: point features drawn uniformly in a square of 20 m, a robot driving round a
/// circle of 5 m radius, 1° of heading per sample, one scan per sample. What the paper leaves out is in the second half
/// and is ours: centre, laps, noise, field of view. Every feature in view is seen; there are no false detections.
struct IhgrCircle {
  int features = 12;
  bool close_features =
      false;  ///< five are within 0.2-0.9 m of each other, where the paper's second experiment has them
  double side_m = 20.0;
  double radius_m = 5.0;
  int samples = 360;  ///< one lap

  Eigen::Vector2d centre_m{10.0, 10.0};
  core::FieldOfView field_of_view{1.0, 30.0, -core::pi / 2.0, core::pi / 2.0};
  double sigma_range_m = 0.1;
  double sigma_bearing_rad = core::pi / 180.0;
  double sigma_distance_m = 0.02;                  ///< odometry, per sample of 0.087 m
  double sigma_turn_rad = 0.3 * core::pi / 180.0;  ///< odometry, per sample of 1°
};

/// Drives it once: a scan at the start and after each sample, assumed noise = true noise. The map frame is that of the
/// start, heading along the circle counter-clockwise; labels are indices of true_landmarks. Features, odometry and
/// scanner draw from streams of their own, so that different noise leaves the layout unchanged. Same arguments, same
/// bytes. InputError for a quantity out of range. Cost: 2 ms. Test: sim/ihgr_circle_test.cpp.
core::Recording simulate_ihgr_circle(const IhgrCircle& world, std::uint64_t seed);

}  // namespace helixnav::sim
