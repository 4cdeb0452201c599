// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tree/state.hpp"

namespace helixnav::atlas {

/// Lays out a subtree anew: phases are split by position, again and again, where the fewest states are shared between both
/// sides, and every variable finds its node. Values below are brought along before; nodes inside and above are dirty.
/// Cost O(n·log² n) for n phases, no numerics.
void lay_out(State& state, int subtree);

/// Lays out the lowest subtree above a leaf that is far deeper than its size demands, if there is one: splits of 30 to 70 % give
/// up to 1.94·log₂ n levels, 2.2·log₂ n + 4 are let pass.
void rebalance(State& state, int leaf);

}  // namespace helixnav::atlas
