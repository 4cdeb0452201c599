// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "tree/state.hpp"

namespace helixnav::atlas {

/// Consecutive phases, connected by the poses where one ends and the next begins.
struct Run {
  int first = 0;
  int last = 0;
};

/// Runs that nothing would hold if `phase` were condensed. Between two condensed phases a run is tied to the rest of the map by
/// the landmarks that it shares with other runs: two of them hold it, one or none leave it free to turn, or to go anywhere, like
/// a street without landmarks whose two ends have been condensed. The map learns nothing from what such a run has seen.
std::vector<Run> floating_without(const State& state, int phase);

}  // namespace helixnav::atlas
