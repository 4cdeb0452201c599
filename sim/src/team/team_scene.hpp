// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/random.hpp"
#include "helixnav/sim/team_world.hpp"

namespace helixnav::sim {

/// The circle that a robot drives at 1 m/s.
struct TeamCircle {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double direction = 1.0;  ///< 1: counter-clockwise, -1: clockwise
  double begin_rad = 0.0;  ///< where on the circle
};

struct TeamScene {
  std::vector<Eigen::Vector2d> landmarks_m;
  std::vector<TeamCircle> circles;  ///< [robot]
  double radius_m = 0.0;            ///< of every circle
  double reach_m = 0.0;             ///< of every scanner
};

/// Landmarks and circles of a kind of world.
TeamScene scene_of(const TeamWorldOptions& options, core::RandomStream& random);

}  // namespace helixnav::sim
