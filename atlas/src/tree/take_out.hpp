// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tree/state.hpp"

namespace helixnav::atlas {

/// Brings up to date the values on all paths that taking out a phase will change.
void bring_ground_along(State& state, int phase);

/// Takes a phase out of the tree: its variables lose the leaf that holds them, and its sibling takes the place of their parent. What
/// remains of the phase is its shape and where it began as seen from `host`, whose variables may have changed.
void take_out(State& state, int phase, int host);

}  // namespace helixnav::atlas
