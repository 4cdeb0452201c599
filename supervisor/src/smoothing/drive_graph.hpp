// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_graph.hpp"
#include "helixnav/core/step_report.hpp"
#include "loop/tape.hpp"

namespace helixnav::supervisor {

/// Where the vehicle stood at a stop of the drive: so far after a pose of the graph.
struct StopInGraph {
  core::Nanoseconds t_ns = 0;
  int pose = 0;
  core::Pose2 T_pose_robot;
};

struct DriveGraph {
  core::LandmarkGraph graph;
  std::vector<StopInGraph> stops;
};

/// The drive as a graph, its edges in the order of the drive. Pose 0 is the start, then there is one for each stop at which
/// something was observed, and the last is where the vehicle is now. Landmarks are, by their present ids, those of the map
/// and those lost again that were seen more than once.
/// Start values: landmarks where the map has them, those `displaced` from where they were first seen; poses as located by
/// the landmarks seen.
/// Test: supervisor/smoothing/smooth_drive_test.cpp.
DriveGraph graph_of(const core::PoseGaussian& start, const Tape& tape, const cekf::CompressedEkf& filter,
                    const std::set<core::LandmarkId>& displaced = {});

/// The path of the drive by the poses of its graph. Test: supervisor/smoothing/smooth_drive_test.cpp.
std::vector<core::StampedPose> path_of(const core::LandmarkGraph& graph, const std::vector<StopInGraph>& stops);

}  // namespace helixnav::supervisor
