// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::apps {

/// A scan: where the robot was, as known at the end, and the landmarks that it saw.
struct Look {
  core::Pose2 T_map_robot;
  std::vector<core::LandmarkId> seen;  ///< ascending
};

/// What a session should have seen, by its own looks. The share of the mature landmarks at a distance and bearing from the robot that a
/// scan detected there is the probability of detection at that distance and bearing: field of view, reach, blind spots and usual
/// occlusion are in it. Test: apps/session_views_test.cpp.
class SessionViews {
 public:
  /// The landmarks of its map.
  SessionViews(std::vector<Look> looks, const core::JointMap& map);

  /// Number of detections that a landmark there would have had on average: the sum of the probabilities over all looks.
  double expected(const Eigen::Vector2d& at_map_m) const;

  /// Number of looks that saw the landmark.
  double detections(core::LandmarkId id) const;

  /// The least of `expected` within a tenth of the distance that the sensor reaches: neither the place nor the edge of what is
  /// in view is known better.
  double surely_expected(const Eigen::Vector2d& at_map_m) const;

  /// Probability that a landmark with so many expected detections has fewer than a mature landmark needs. Negative binomial: how much
  /// the session's own landmarks differ in how well they are seen is in it.
  double missed_by_chance(double expected_detections) const;

 private:
  static constexpr std::size_t rings = 12, sectors = 24;
  struct Cell {
    double looks = 0.0, detections = 0.0;
  };

  /// Nothing beyond the last ring.
  std::optional<std::size_t> cell(const core::Pose2& T_map_robot, const Eigen::Vector2d& at_map_m) const;
  void measure_reach(const core::JointMap& map);
  void count(const core::JointMap& map);
  void fill_sparse_cells();
  void measure_spread(const core::JointMap& map);

  std::vector<Look> looks_;
  double ring_m_ = 0.0;  ///< width
  std::array<Cell, rings * sectors> cells_;
  double spread_ = 0.0;  ///< variance of the landmarks' own factors on the expected number
};

}  // namespace helixnav::apps
