// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/supervisor/find_slip.hpp"
#include "slip/relative_geometry.hpp"
#include "slip/slip_evidence.hpp"
#include "slip/slip_places.hpp"

namespace helixnav::supervisor {

/// How many observations, the nearest of all, are weighed; this sets the cost of the slip question.
constexpr std::size_t most_weighed = 24;

std::vector<Eigen::Vector2d> means_m(const std::vector<SlipLandmark>& landmarks);

/// If a scan has as many observations as are weighed, or more: keeps only landmarks that one of the weighed may be of,
/// and their neighbours. What is left out would be paired with nothing. `seen`: nearest first.
/// Test: supervisor/slip/keep_weighed_test.cpp (the same slips as without).
void keep_weighed(const core::Pose2& T_world_robot, const core::Scan& scan, const std::vector<SeenPoint>& seen,
                  const SlipComponent& widest, SlipReach reach, std::vector<SlipLandmark>& near);

}  // namespace helixnav::supervisor
