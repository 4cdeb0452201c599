// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "tree/state.hpp"

namespace helixnav::atlas {

/// Computes a node's estimates from its front and those above, and decides what is bent and which children follow.
void open(State& state, int node);

/// Finishes a downward pass that was stopped, so that all values are consistent. Before every change.
void finish_descent(State& state);

/// Eliminates dirty nodes, children first. False when it was stopped.
bool redo_dirty(State& state, int& redone, const std::function<bool()>& should_stop);

/// Eliminates dirty nodes and leaves all values where they are, as those of a settled map: they solve it already, and where measurements
/// tear it, relinearising everything at once would not find the solution again.
void linearise_in_place(State& state);

}  // namespace helixnav::atlas
