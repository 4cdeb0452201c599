// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/events.hpp"
#include "helixnav/relocalize/question.hpp"
#include "helixnav/supervisor/search_options.hpp"
#include "loop/belief.hpp"

namespace helixnav::supervisor {

/// What the session has mapped about the vehicle, as a question to another map: the mature landmarks nearest to the vehicle
/// that were seen within the length of a branch, 40 at most, with covariances relative to each other on top of the noise of a
/// pair, and the ground that the sensor looked at meanwhile. Session frame.
relocalize::Question session_question(const Belief& belief, const core::FieldOfView& view, double reach_m,
                                      double pair_noise_m, const SearchOptions& options);

}  // namespace helixnav::supervisor
