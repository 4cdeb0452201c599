// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/random.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::core::testing {

/// Number of random states on which a law is tested.
inline constexpr int states = 300;

/// Every third heading is within 1 µrad of ±π, where a step of central differences crosses the cut.
inline double random_heading(RandomStream& random) {
  if (random.below(3) != 0) return random.uniform(-pi, pi);
  const double near_pi = pi - random.uniform(0.0, 1e-6);
  return random.bernoulli(0.5) ? near_pi : -near_pi;
}

inline Pose2 random_pose(RandomStream& random, double reach_m = 50.0) {
  const double x_m = random.uniform(-reach_m, reach_m);
  const double y_m = random.uniform(-reach_m, reach_m);
  return {x_m, y_m, random_heading(random)};
}

/// (x, y, heading) a − b with the heading wrapped.
inline Eigen::VectorXd pose_difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  Eigen::VectorXd d = a - b;
  d[2] = wrap_to_pi(d[2]);
  return d;
}

inline double pose_distance(const Pose2& a, const Pose2& b) { return pose_difference(a.vector(), b.vector()).norm(); }

}  // namespace helixnav::core::testing
