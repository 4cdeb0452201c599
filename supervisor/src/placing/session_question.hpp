// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

#include "helixnav/core/events.hpp"
#include "helixnav/relocalize/map_index.hpp"
#include "helixnav/relocalize/question.hpp"
#include "loop/belief.hpp"

namespace helixnav::supervisor {

/// What the session has mapped around the vehicle: the mature landmarks nearest to it that were seen within the length
/// of a branch and begun after `born_after_path_m`, 40 at most.
struct LandmarksAbout {
  std::vector<core::LandmarkId> ids;                          ///< nearest first
  double within_m = std::numeric_limits<double>::infinity();  ///< of the vehicle: beyond, landmarks were left out
};
LandmarksAbout landmarks_about(const Belief& belief, double seen_within_m,
                               double born_after_path_m = -std::numeric_limits<double>::infinity());

/// These as a question to another map, session frame: covariances relative to each other on top of the noise of a pair,
/// and the ground that the sensor looked at meanwhile.
relocalize::Question session_question(const Belief& belief, const LandmarksAbout& about, const core::FieldOfView& view,
                                      const relocalize::IndexOptions& lengths, double seen_within_m);

}  // namespace helixnav::supervisor
