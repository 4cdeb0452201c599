// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/se2.hpp"

namespace helixnav::evaluation {

/// The rigid motion that aligns the points of frame b with those of frame a, and the pairs it was computed from.
struct RigidAlignment {
  core::Pose2 T_a_b;
  std::vector<bool> used;  ///< [pair] residual within the limit
  int used_count = 0;
};

/// Least-squares rotation and translation (3 degrees of freedom, no scale) with points_a[i] ≈ T_a_b · points_b[i] over
/// the pairs whose residual is at most `limit_m`; pairs and motion are found together by iterating until the set of
/// pairs no longer changes. Two starting points are tried, all pairs and the least median of residuals over 500 pairs
/// drawn with a fixed seed; the one that keeps more pairs wins. Tolerates up to about 40 % gross outliers. Closed form
/// of each iteration: heading = atan2(Σ b×a, Σ b·a) over centred points. With fewer than two distinct points the
/// heading is 0. PreconditionError when the lists differ in length. Cost O(1000·n). Test: evaluation/alignment_test.cpp
/// (known motion, 10 % and 40 % outliers).
RigidAlignment align_rigidly(const std::vector<Eigen::Vector2d>& points_a, const std::vector<Eigen::Vector2d>& points_b,
                             double limit_m);

}  // namespace helixnav::evaluation
