// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "helixnav/sim/team_world.hpp"

namespace helixnav::apps {

/// A kind of world of the campaign.
struct TeamTrial {
  std::string name;
  sim::TeamWorldOptions world;
};

/// The worlds of a seed: "shared", "apart", "chain" (three robots in a row, each sharing landmarks with the next) and
/// "orchard", which cycles through four pitches and four jitters.
std::vector<TeamTrial> trials_of(std::uint64_t seed);

/// The outcome for a world, judged by the truth alone.
struct TeamVerdict {
  bool failed = false;  ///< the mathematics broke down; the other fields are then invalid
  bool joined = false;  ///< all robots are in one frame
  bool wrong =
      false;       ///< two robots in one frame have a wrong relative pose, or most of the landmarks that were merged
                   ///< in their frame are two
  int merged = 0;  ///< landmarks that several robots share at the end
  int merged_wrong = 0;                   ///< of these, the wrong ones
  double t_s = 0.0;                       ///< of the last join
  double error_m = 0.0, error_rad = 0.0;  ///< worst of all pairs of robots in one frame, at the end
};

/// Simulates and navigates: each robot tells its own landmarks apart with its own navigator; joins may come only from
/// constellations.
TeamVerdict judge_world(const TeamTrial& trial, std::uint64_t seed);

}  // namespace helixnav::apps
