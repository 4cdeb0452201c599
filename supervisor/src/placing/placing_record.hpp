// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loop/belief.hpp"
#include "loop/tape.hpp"
#include "placing/maps_apart.hpp"

namespace helixnav::supervisor {

/// The part as it was before its place on another map was found, so that it can be placed again if that place turns out
/// to be wrong. What came in since is on the tape, from `since` on.
struct PlacingRecord {
  core::PoseGaussian start;
  Belief belief;
  Tape tape;
  MapsApart apart;
  Tape::Position since = 0;
  double path_m = 0.0;     ///< length of the drive until then
  double evidence = 0.0;   ///< of the place, as in core::PlacedDecision
  core::Pose2 T_map_part;  ///< frames of the map and of the part as it was reported until then
};

}  // namespace helixnav::supervisor
