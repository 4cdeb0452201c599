// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/association/landmark_life.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "loop/tape.hpp"

namespace helixnav::supervisor {

/// The length of the drive since which views tie it to the present: from there until now, at least two landmarks were seen
/// both before and after every place, with at most gap_m between. Beyond it only odometry says where the rest is, and a
/// vehicle that slips may have slipped there with nothing in view to show it. `path_m`: now. As far back as the tape goes,
/// if it holds all of it. O(observations on the tape). Test: supervisor/closing/tied_by_view_test.cpp.
double tied_since_m(const Tape& tape, double path_m, double gap_m);

/// Those of `ids` that were seen after `path_m`.
std::vector<core::LandmarkId> seen_since(double path_m, const association::LandmarkLife& life,
                                         const std::vector<core::LandmarkId>& ids);

}  // namespace helixnav::supervisor
