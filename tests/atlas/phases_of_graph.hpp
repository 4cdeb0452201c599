// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "helixnav/atlas/phase_log.hpp"
#include "helixnav/core/landmark_graph.hpp"

namespace helixnav::atlas::testing {

/// The phases of a graph whose pose edges form one chain, each at least `length_m` long. Landmarks are named by index.
inline std::vector<std::shared_ptr<PhaseLog>> phases_of_graph(const core::LandmarkGraph& graph, double length_m) {
  std::vector<std::vector<SeenLandmark>> seen(graph.poses.size());
  for (const auto& edge : graph.landmark_edges) {
    seen[static_cast<std::size_t>(edge.pose)].push_back({edge.landmark, edge.T_robot_sensor, edge.observation});
  }
  std::vector<std::shared_ptr<PhaseLog>> logs;
  double driven_m = length_m;
  for (std::size_t k = 0; k < graph.pose_edges.size(); ++k) {
    const auto& edge = graph.pose_edges[k];
    if (driven_m >= length_m) {
      logs.push_back(std::make_shared<PhaseLog>());
      driven_m = 0.0;
    }
    if (k == 0) logs.back()->seen_at_entry = seen[0];
    logs.back()->steps.push_back({edge.T_from_to, edge.covariance, seen[static_cast<std::size_t>(edge.to)]});
    driven_m += edge.T_from_to.position_m().norm();
  }
  return logs;
}

}  // namespace helixnav::atlas::testing
