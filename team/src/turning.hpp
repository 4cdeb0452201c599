// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/se2.hpp"

namespace helixnav::team {

/// Poses and points with their joint covariance, (x, y, heading) of each robot, then (x, y) of each landmark, where a
/// whole neighbourhood may be turned about a place that is not known: a robot that has lost its heading, and what it has
/// begun since. Of that turn no observation within the neighbourhood may tell anything. It is a direction of the
/// covariance, J·(landmark − place) per radian: if an update moves the landmark and leaves its covariance as it is, the
/// direction no longer fits, and later observations seem to measure the turn. So positions are moved on arcs of the turn, and the
/// direction is turned with them (the error of the right-invariant filter, per landmark with the robot it belongs to).
/// Test: team/lost_heading_test.cpp.
struct Turning {
  std::vector<core::Pose2>& poses;
  std::vector<Eigen::Vector2d>& points_m;
  Eigen::MatrixXd& covariance;
};

/// [landmark] the robot relative to which it is known best; the number of robots where it is known better in the world, as
/// what was mapped before a robot lost its heading.
std::vector<std::size_t> turning_with(const Turning& joint);

/// Adds the step of an update by an observation of `observer`.
void add_step(std::size_t observer, const Eigen::VectorXd& step, Turning joint);

}  // namespace helixnav::team
