// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "helixnav/runs/run.hpp"

namespace helixnav::runs {

/// The frame in which a step was reported. A session that looks for its place on an earlier map reports its steps in a
/// frame of its own until that is found, and so does each part of a drive after the vehicle was carried.
struct FrameOfStep {
  int times_carried = 0;         ///< up to then
  int reported_part = 0;         ///< the part whose frame that was
  int part = 0;                  ///< the part whose frame it is in at the end
  core::Pose2 T_final_reported;  ///< from that frame into the one in which it is known at the end
  core::Pose2 T_final_solved;    ///< likewise of a solution of the drive so far, made before this step found its place
};

/// [step]
std::vector<FrameOfStep> frames_of(const Run& run);

/// Whether some step found the relation of the frame of earlier steps to another.
bool has_found_place(const Run& run);

/// Moves what was reported in another frame into the one in which it is known at the end, so that a run has one frame,
/// or one for each part whose relation to the others is unknown. Covariances are rotated; that of the pose itself is
/// left out. Test: runs/placed_run_test.cpp.
void bring_into_map(Run& run);

/// [step] the poses.
std::vector<core::Pose2> poses_of(const Run& run);

}  // namespace helixnav::runs
