// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/se2.hpp"

namespace helixnav::core {

/// T_a_b of least Σ|a − T_a_b·b|², closed form: heading = atan2(Σ b×a, Σ b·a) over centred points. Heading 0 with fewer
/// than two distinct points, the identity without any. The lists are equally long.
/// Test: evaluation/alignment_test.cpp.
Pose2 fit_rigidly(const std::vector<Eigen::Vector2d>& points_a, const std::vector<Eigen::Vector2d>& points_b);

}  // namespace helixnav::core
