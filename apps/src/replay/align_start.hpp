// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/odometry.hpp"

namespace helixnav::apps {

/// A fix, and how the vehicle came there.
struct FixOnTheWay {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< of the antenna, in the frame of the fixes
  double sigma_m = 0.0;
  core::Odometry since_last;   ///< motion since the fix before, or since the start
  core::Odometry since_start;  ///< dead reckoning
};

struct AlignedStart {
  core::PoseGaussian start;  ///< of the robot in the frame of the fixes
  int agreeing = 0;          ///< fixes that it was computed from; the others are outliers
  int fixes = 0;
};

/// The start of a drive in the frame of its fixes, from the first of them. Two steps: which fixes agree with the
/// dead-reckoned path after a rigid motion, by least median of squares; then the posterior of the start given these, a fixed-point
/// smoother (a Kalman filter over the pose now and the pose at the start), so that the noise of the odometry between
/// the fixes counts as the random walk that it is. The errors of a receiver last: all of these fixes together are
/// worth two. How far a fix may be from the path is 4 σ, or twice that, four times, …: whichever makes the residuals of all fixes
/// likeliest, if those within are evenly spread there and the others over the farthest; from there, 4 σ of the residuals
/// themselves. So errors that are larger than stated are told from outliers.
/// At least two fixes. Cost O(n). Test: apps/align_start_test.cpp.
AlignedStart align_start(const std::vector<FixOnTheWay>& fixes, const Eigen::Vector2d& antenna_robot_m);

}  // namespace helixnav::apps
