// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/observation.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::cekf {

/// An observation that has been attributed to a landmark of the map.
struct Match {
  core::LandmarkId landmark = core::no_landmark;
  core::Observation observation;
  core::Pose2 T_robot_sensor;
};

/// What an update says of itself: nis is νᵀS⁻¹ν, or, of an iterated update, the cost J at its minimum; either is
/// χ²-distributed with dof degrees of freedom when the model holds.
struct UpdateResult {
  double nis = 0.0;
  int dof = 0;
};

/// The same with the share of each match (or pair) in the cost, for a caller who wants to drop the worst.
struct CostByPart {
  double cost = 0.0;
  int dof = 0;
  std::vector<double> parts;
};

}  // namespace helixnav::cekf
