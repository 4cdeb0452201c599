// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "helixnav/supervisor/join_sessions.hpp"

namespace helixnav::apps {

/// χ² (2 degrees of freedom) of two landmarks of a joined map, by their indices, being one: by the joint covariance, and by the reach/200
/// by which what two drives see of one landmark differs, for each.
double chi2_as_one(const core::JointMap& component, std::size_t a, std::size_t b, double reach_m);

/// Pairs of landmarks of a component that may be one landmark each, left on the map twice: no session has both, and χ² is within its 99 %
/// quantile. Each landmark is in one pair at most, the nearest pairs first. They were not merged because neighbours could equally be
/// meant. O(N²). Test: apps/session_changes_test.cpp.
std::vector<std::pair<core::LandmarkId, core::LandmarkId>> left_double(const supervisor::JoinedSessions& joined,
                                                                       std::size_t number, double reach_m);

}  // namespace helixnav::apps
