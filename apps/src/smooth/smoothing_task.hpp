// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "helixnav/core/landmark_graph.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/smoothing/problem.hpp"

namespace helixnav::apps {

using Ids = std::vector<std::vector<std::int64_t>>;

/// For the indices of the graph, which are int because −1 means none.
inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A recording whose associations are fixed, as a least-squares problem.
struct SmoothingTask {
  smoothing::Problem problem;
  std::vector<core::Nanoseconds> times;   ///< [step]
  std::vector<int> pose_of_step;          ///< [step] index of its pose
  std::vector<std::vector<int>> edge_of;  ///< [step][observation] index of its landmark edge, −1 if left out
  int unlabelled_observations = 0;
  int unlocated_landmarks = 0;
  int undetermined_landmarks = 0;  ///< left out of a solution: their observations do not fix their place
  bool softened_odometry = false;  ///< covariances of rank two got `rank_sigma` on the diagonal
};

/// σ added to odometry whose covariance cannot be inverted (Ackermann models have only two noises): x, y [m], heading
/// [rad].
extern const Eigen::Vector3d rank_sigma;

SmoothingTask task_from_recording(const core::Recording& recording, const Ids& ids);

/// A g2o graph: step k is pose k, at t = k seconds.
SmoothingTask task_from_graph(core::LandmarkGraph graph);

/// [step][observation] landmark that a filter matched or began, else −1; for one that a closure merged into another,
/// that other one.
Ids ids_of_run(const std::vector<core::StepReport>& steps, const core::Recording& recording);

/// Starts poses and landmarks where a run left them. Landmarks are recognised by the observations they share; one that
/// the run does not know keeps its place relative to the pose that saw it first. InputError if the run's steps differ
/// from the task's.
void start_from_run(const std::string& name, const std::vector<core::StepReport>& steps,
                    const std::vector<core::Pose2>& poses, const std::vector<core::MapLandmark>& map,
                    SmoothingTask& task);

}  // namespace helixnav::apps
