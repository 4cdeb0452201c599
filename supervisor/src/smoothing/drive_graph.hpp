// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_graph.hpp"
#include "loop/tape.hpp"

namespace helixnav::supervisor {

/// The drive as a graph, its edges in the order of the drive. Pose 0 is the start, then there is one for each stop at which
/// something was observed, and the last is where the vehicle is now. Landmarks are, by their present ids, those of the map
/// and those lost again that were seen more than once.
/// Start values: landmarks where the map has them, poses as located by the landmarks seen.
/// Test: supervisor/smooth_drive_test.cpp.
core::LandmarkGraph graph_of(const core::PoseGaussian& start, const Tape& tape, const cekf::CompressedEkf& filter);

}  // namespace helixnav::supervisor
