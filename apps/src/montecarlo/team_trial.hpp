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

/// The worlds of a seed: "shared", "apart", "chain" (three robots in a row, each with landmarks in common with the next) and
/// "orchard", of which four pitches and four jitters take turns.
std::vector<TeamTrial> trials_of(std::uint64_t seed);

/// What became of a world, judged by the truth alone.
struct TeamVerdict {
  bool failed = false;  ///< the mathematics broke down; nothing else holds then
  bool joined = false;  ///< all robots are in one frame
  bool wrong =
      false;       ///< two robots are in one frame that are not where they stand to each other, or in whose frame most
                   ///< landmarks that were made one are two
  int merged = 0;  ///< landmarks that several robots share at the end
  int merged_wrong = 0;                   ///< of them, those that are not one
  double t_s = 0.0;                       ///< of the last join
  double error_m = 0.0, error_rad = 0.0;  ///< worst of all pairs of robots in one frame, at the end
};

/// Simulates and navigates: each robot tells its own landmarks apart by a navigator of its own, nothing but constellations may
/// join.
TeamVerdict judge_world(const TeamTrial& trial, std::uint64_t seed);

}  // namespace helixnav::apps
