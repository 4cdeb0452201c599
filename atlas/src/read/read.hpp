// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/se2.hpp"
#include "solve/estimates.hpp"
#include "tree/state.hpp"

namespace helixnav::atlas {

/// The rigid motion from the atlas' own frame to the map's.
core::Pose2 T_map_atlas(const State& state, Estimates& estimates);

/// Variable of a landmark with a name; PreconditionError when there is none.
int variable_of_named(const State& state, core::LandmarkId id);

}  // namespace helixnav::atlas
