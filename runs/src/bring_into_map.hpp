// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "helixnav/runs/run.hpp"

namespace helixnav::runs {

/// The frame in which a step was told. A session that looks for its place on an earlier map tells its steps in a frame of its
/// own until that is found, and so does each part of a drive after the vehicle was carried.
struct FrameOfStep {
  int times_carried = 0;         ///< until then
  int reported_part = 0;         ///< whose frame that was
  int part = 0;                  ///< whose frame it is in at last
  core::Pose2 T_final_reported;  ///< from that frame into the one in which it is known at last
};

/// [step]
std::vector<FrameOfStep> frames_of(const Run& run);

/// Whether it was found in some step how the frame of steps before lies to another.
bool has_found_place(const Run& run);

/// Moves what was told in another frame into the one in which it is known at last, so that a run has one frame, or as many as it
/// has parts of which nobody knows how they lie to each other. Covariances are turned; that of the pose itself is left out.
/// Test: runs/placed_run_test.cpp.
void bring_into_map(Run& run);

/// [step] the poses.
std::vector<core::Pose2> poses_of(const Run& run);

}  // namespace helixnav::runs
