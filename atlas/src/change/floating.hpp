// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "tree/state.hpp"

namespace helixnav::atlas {

/// Phases that follow one another and hang together by the poses where one ends and the next begins.
struct Run {
  int first = 0;
  int last = 0;
};

/// Runs that nothing would hold if `phase` were condensed. Between two condensed phases a run hangs on the rest of the map by the
/// landmarks that it shares with other runs: two of them hold it, one or none leave it free to turn, or to go anywhere, as a
/// street without a landmark does whose both ends have been condensed. Of what such a run has seen the map learns nothing.
std::vector<Run> floating_without(const State& state, int phase);

}  // namespace helixnav::atlas
