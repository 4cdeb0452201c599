// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::team {

/// What may bring two components into one frame.
struct JoinOptions {
  bool by_names = true;
  bool by_sightings = true;
  bool by_constellation = false;
  double pair_s = 0.5;          ///< two robots that see each other within this time
  double window_s = 30.0;       ///< sightings as old as this still count for the relative pose of two robots
  double probability = 0.999;   ///< χ² test of a join
  double max_sigma_m = 0.5;     ///< of the joined robots' relative position, else it is too early for a join by names
  double max_sigma_rad = 0.1;   ///< of their relative heading, likewise
  int mature_observations = 5;  ///< of a landmark that may support a join
  bool by_place = false;        ///< landmarks of one component that are in one place become one (SameLandmarks)
};

struct TeamOptions {
  double solve_every_s = 5.0;     ///< least time between two solutions of the graph
  double solve_share = 0.02;      ///< of the time so far, likewise: so the cost of all stays in proportion to the last
  double clone_sigma_m = 0.005;   ///< a sighting opens a pose of the graph where the motion since the last one is as
  double clone_sigma_rad = 0.01;  ///< uncertain as this
  double gate_probability = 0.999999;  ///< of the innovation of a sighting
  double looks_as_one =
      1.0;            ///< this many looks at a landmark in a row say what one would, and the noise given is that of
                      ///< all of them: scans without names are told apart by the noise of one look, R divided by it
  bool slips = true;  ///< scans without names are asked whether the robot slipped before them (RobotSlip)
  JoinOptions join;
};

}  // namespace helixnav::team
