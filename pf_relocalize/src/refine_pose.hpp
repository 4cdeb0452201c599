// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "tile_sum.hpp"

namespace helixnav::pf_relocalize {

/// One Gauss–Newton step of expectation maximisation on Π_j (1 + ratio Σ_i N(m_j(x); m_i, Σ_i + R_j + soften²·I)): every
/// point is drawn to the landmarks near it, by responsibility. Returns the pose after the step.
core::Pose2 refine_pose(const LandmarkTable& table, const std::vector<RobotPoint>& points, double density_ratio_m2,
                        double soften_m, const core::Pose2& pose);

}  // namespace helixnav::pf_relocalize
