// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "small_drive.hpp"
#include "tree/state.hpp"

namespace helixnav::atlas::testing {

inline int index_of_landmark(const smoothing::Problem& problem, core::LandmarkId id) {
  const auto& all = problem.graph.landmarks;
  return static_cast<int>(std::find_if(all.begin(), all.end(), [id](const auto& l) { return l.name == id; }) -
                          all.begin());
}

/// Names of the landmarks that a phase saw.
inline std::set<core::LandmarkId> seen_by(const PhaseLog& log) {
  const std::vector<core::LandmarkId> ids = landmarks_of(log);
  return {ids.begin(), ids.end()};
}

/// The least-squares problem of a drive, cut as its atlas has been condensed: a condensed phase has an entry, an exit and landmarks
/// of its own, except for the landmarks of its host. Landmarks of its own have negative names; its own poses come after
/// those of the drive. Poses that nothing constrains any more are fixed.
inline smoothing::Problem cut_problem(const SmallDrive& drive, const State& state) {
  smoothing::Problem cut = drive.problem;
  core::LandmarkGraph& graph = cut.graph;
  for (std::size_t k = 0; k < state.phases.size(); ++k) {
    const int host = state.phases[k]->host;
    if (host < 0) continue;
    const std::set<core::LandmarkId> kept = seen_by(*drive.logs[static_cast<std::size_t>(host)]);
    const int first = drive.pose_of_clone[k];
    const int last = drive.pose_of_clone[k + 1];
    const auto own_pose = [&graph](int pose) {
      graph.poses.push_back(graph.poses[static_cast<std::size_t>(pose)]);
      return static_cast<int>(graph.poses.size()) - 1;
    };
    const int entry = own_pose(first);
    const int exit = own_pose(last);
    std::map<int, int> own;
    for (auto& edge : graph.pose_edges) {
      if (edge.to <= first || edge.to > last) continue;
      if (edge.from == first) edge.from = entry;
      if (edge.to == last) edge.to = exit;
    }
    for (auto& edge : graph.landmark_edges) {
      if (edge.pose <= first || edge.pose > last) continue;
      if (edge.pose == last) edge.pose = exit;
      const core::LandmarkGraph::Landmark landmark = graph.landmarks[static_cast<std::size_t>(edge.landmark)];
      if (landmark.name < 0 || kept.count(static_cast<core::LandmarkId>(landmark.name)) > 0) continue;
      const auto [place, is_new] = own.try_emplace(edge.landmark, static_cast<int>(graph.landmarks.size()));
      if (is_new) graph.landmarks.push_back({-1 - landmark.name, landmark.point_m});
      edge.landmark = place->second;
    }
  }
  std::vector<bool> held(graph.poses.size(), false);
  for (const auto& edge : graph.pose_edges) {
    held[static_cast<std::size_t>(edge.from)] = held[static_cast<std::size_t>(edge.to)] = true;
  }
  for (std::size_t pose = 0; pose < held.size(); ++pose) {
    if (!held[pose]) cut.fixed_poses.push_back(static_cast<int>(pose));
  }
  return cut;
}

}  // namespace helixnav::atlas::testing
