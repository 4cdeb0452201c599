// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::core {

/// A trajectory and landmarks tied by measurements whose associations are settled: what graph files hold and what
/// smoothing solves. Indices count from 0 in the vectors below; `name` is what a file, a scan or a label calls it.
struct LandmarkGraph {
  struct Pose {
    std::int64_t name = 0;
    Pose2 T_world_robot;
  };
  struct Landmark {
    std::int64_t name = 0;
    Eigen::Vector2d point_m = Eigen::Vector2d::Zero();
  };
  /// T_from_to with covariance in (x, y, heading) of the frame of `from` [m, m, rad].
  struct PoseEdge {
    int from = 0;
    int to = 0;
    Pose2 T_from_to;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  };
  struct LandmarkEdge {
    int pose = 0;
    int landmark = 0;
    Pose2 T_robot_sensor;
    Observation observation;
  };
  struct FixEdge {
    int pose = 0;
    AbsoluteFix fix;
  };

  std::vector<Pose> poses;
  std::vector<Landmark> landmarks;
  std::vector<PoseEdge> pose_edges;
  std::vector<LandmarkEdge> landmark_edges;
  std::vector<FixEdge> fix_edges;
};

/// A graph made from events, with what could not enter it.
struct GraphFromEvents {
  LandmarkGraph graph;
  std::vector<int> pose_of_scan;    ///< [scan] index of its pose
  int unlabelled_observations = 0;  ///< id below zero
  int unlocated_landmarks = 0;      ///< left out with their observations: too few rows to fix a point
};

/// Pose 0 is at `start`; every scan or fix that follows motion opens the next pose (increments are chained), named by
/// its index. ids[scan][observation] names the landmark observed, below zero: unknown. Poses are dead reckoned,
/// landmarks placed by locate_landmarks; those whose observations have fewer than two rows are left out and counted.
/// Motion after the last scan or fix is dropped. PreconditionError when the shape of ids does not match the events,
/// InputError where the vehicle was carried (Lost): no motion ties the poses before to those after.
/// Test: core/landmark_graph_test.cpp.
GraphFromEvents graph_from_events(const std::vector<Event>& events, const std::vector<std::vector<std::int64_t>>& ids,
                                  const Pose2& start = Pose2());

/// Places landmarks from the poses of the graph: at the first observation that fixes a point, else where all bearings
/// cross, else where all ranges meet (both linear least squares; a mirror ambiguity of ranges from a straight path stays
/// undecided). Landmarks that even this leaves open (parallel bearings) go to 3 m along the first bearing.
/// Cost linear in the number of edges. Test: core/landmark_graph_test.cpp.
void locate_landmarks(LandmarkGraph& graph);

}  // namespace helixnav::core
