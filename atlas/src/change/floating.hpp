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

/// Whether the other runs beside `phase` still hold each other without it: two landmarks that two of them share do, and so do chains of
/// further runs. Runs that only hold each other would turn about the one landmark that they share with the rest. O(phases of all
/// but the longest run); false if that is more than 2000. Test: atlas/condense_test.cpp.
bool hold_each_other_without(const State& state, int phase);

}  // namespace helixnav::atlas
