// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/relocalize/landmark.hpp"

namespace helixnav::relocalize {

/// What was believed of the branch's pose. With probability ε the belief is wrong and the branch is anywhere on the map's
/// ground: p(T) = (1 − ε) N(T; prior) + ε / (2πA). It weighs places and never excludes one.
struct Prior {
  core::PoseGaussian T_map_branch;
  double epsilon = 0.03;  ///< in (0, 1); 0.01 to 0.1 is sensible
};

/// A constellation that asks where it is: landmarks mapped since the place was lost, in the frame of that branch. What was
/// driven should be rigid within two pair noises; 20 landmarks are worth waiting for.
struct Question {
  std::vector<Landmark> landmarks;
  std::vector<Disc> looked;  ///< ground the branch looked at: there it would have found the landmarks of the map
  std::optional<Prior> prior;
};

/// Ground that was surely looked at about points of a constellation, nearest to its centre first: discs about them, 0.6 of the way to
/// the eighth of the others, none beyond the farthest. For constellations of a map whose covered ground was not recorded.
std::vector<Disc> ground_around(const std::vector<Eigen::Vector2d>& nearest_first_m, double reach_m);

}  // namespace helixnav::relocalize
