// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tree/state.hpp"

namespace helixnav::atlas {

/// Brings the values along on all paths that taking out a phase will change.
void bring_ground_along(State& state, int phase);

/// Takes a phase out of the tree: its variables lose a leaf that holds them, its sibling takes the place of their parent. Of the phase
/// stay its shape and where it began, seen from `host`, whose variables may have changed.
void take_out(State& state, int phase, int host);

}  // namespace helixnav::atlas
