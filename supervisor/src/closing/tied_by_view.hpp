// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/association/landmark_life.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "loop/tape.hpp"

namespace helixnav::supervisor {

/// The length of the drive since when what was seen ties it to the present: back from now there is no place that fewer than two
/// landmarks were seen both before and after, with at most gap_m between. Beyond it only odometry says how the rest lies, and a
/// vehicle that slips may have slipped there with nothing in view to show it. `path_m`: now. As far back as the tape goes, where it holds all
/// of it. O(observations on the tape). Test: supervisor/closing/tied_by_view_test.cpp.
double tied_since_m(const Tape& tape, double path_m, double gap_m);

/// Those of `ids` that were seen since.
std::vector<core::LandmarkId> seen_since(double path_m, const association::LandmarkLife& life,
                                         const std::vector<core::LandmarkId>& ids);

}  // namespace helixnav::supervisor
