// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "tree/state.hpp"

namespace helixnav::atlas {

/// Decides again what a node eliminates, from its children or its leaf: a variable is eliminated where the last leaf that
/// holds it joins the others. The node is marked as having no front.
void shape_front(State& state, int node);

/// The same for all nodes given and all above them, children first, and marks them dirty.
void shape_paths(State& state, const std::vector<int>& nodes);

}  // namespace helixnav::atlas
