// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tree/state.hpp"

namespace helixnav::atlas {

/// Lays out a subtree anew: phases are split recursively by position, where the two sides share the fewest states, and
/// every variable finds its node. Values below are brought up to date first; nodes inside and above become dirty. Cost
/// O(n·log² n) for n phases, no numerics.
void lay_out(State& state, int subtree);

/// Builds the tree of a state whose variables, values, names and phases are given; whatever tree it had is dropped. All
/// nodes are dirty. Cost as lay_out.
void lay_out_anew(State& state);

/// Lays out the lowest subtree above a leaf that is far deeper than its size demands, if there is one: splits of 30 to 70 % give
/// up to 1.94·log₂ n levels; up to 2.2·log₂ n + 4 are tolerated.
void rebalance(State& state, int leaf);

}  // namespace helixnav::atlas
