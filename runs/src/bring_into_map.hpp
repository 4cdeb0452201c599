// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "helixnav/runs/run.hpp"

namespace helixnav::runs {

/// The step in which a session found its place on an earlier map, if it did.
std::optional<std::size_t> step_of_placing(const Run& run);

/// Steps before it were told in the session's own frame: moves them into that of the map, by the pose that the decision
/// names, so that a run has one frame. Covariances are turned; that of the pose itself is left out.
/// Test: runs/placed_run_test.cpp.
void bring_into_map(Run& run);

/// What brings a pose told at `t_ns` into the frame of the map: nothing to do where there is none.
std::optional<core::Pose2> frame_at(const Run& run, core::Nanoseconds t_ns);

/// [step] the poses.
std::vector<core::Pose2> poses_of(const Run& run);

}  // namespace helixnav::runs
