// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "tree/state.hpp"

namespace helixnav::atlas {

/// Draws the estimates of a node from its front and those above, decides what is bent, and which children follow.
void open(State& state, int node);

/// Ends a way down that was stopped, so that all values belong together. Before every change.
void finish_descent(State& state);

/// Eliminates dirty nodes, children first. False when it was stopped.
bool redo_dirty(State& state, int& redone, const std::function<bool()>& should_stop);

}  // namespace helixnav::atlas
