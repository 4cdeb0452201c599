// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "helixnav/core/team_recording.hpp"

namespace helixnav::sim {

enum class TeamWorldKind {
  shared,   ///< robots side by side, each of which sees a disc of landmarks; neighbours' discs overlap
  apart,    ///< the same discs far from each other: nothing in common
  orchard,  ///< robots within a lattice of trees larger than what any of them sees: every shift looks right
};
const char* name_of(TeamWorldKind kind);

/// A world for several robots, each of which drives round a circle and sees all landmarks of a disc around it, and
/// nothing else.
struct TeamWorldOptions {
  TeamWorldKind kind = TeamWorldKind::shared;
  int robots = 2;
  int landmarks_each = 20;        ///< shared, apart: within a robot's disc
  int common = 10;                ///< shared: with each neighbour
  double pitch_m = 8.0;           ///< orchard; circles and views are in proportion to it
  double jitter_m = 0.0;          ///< orchard: standard deviation of each tree's place in x and y
  double clutter_per_scan = 0.5;  ///< mean of a Poisson number
  bool see_each_other = false;    ///< robots see each other as far as they see landmarks
};

/// Drives it for about two laps: odometry and a scan every second, with white noise of 0.05 m/s and 0.02 rad/s, 0.1 m
/// and 1°; a landmark in view is detected with probability 0.9. Starts and truth are in the world frame, labels are
/// indices of true_landmarks (no_label: clutter), observations of a scan are in random order. World, odometry and
/// scanner of each robot draw from streams of their own; the same options and seed give the same bytes.
/// PreconditionError unless 2 ≤ robots, 1 ≤ landmarks_each ≤ 100, 1 ≤ common, a robot's landmarks suffice for all its
/// neighbours, 2 m ≤ pitch_m, 0 ≤ jitter_m. Test: sim/team_world_test.cpp.
core::TeamRecording simulate_team(const TeamWorldOptions& options, std::uint64_t seed);

}  // namespace helixnav::sim
