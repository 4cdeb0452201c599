// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/landmark_graph.hpp"
#include "helixnav/core/observation.hpp"

namespace helixnav::supervisor {

/// Drives through a solved graph with measurements that are just what it predicts: the mean stays on it, and the
/// covariance comes to be that of all measurements linearised there. The slow twin of solving for it.
class FilterAlong {
 public:
  FilterAlong(const core::LandmarkGraph& graph, const Eigen::Matrix3d& start_covariance)
      : graph_(graph), filter_({graph.poses.front().T_world_robot, start_covariance}) {}

  cekf::CompressedEkf run() {
    for (int pose = 0; pose < static_cast<int>(graph_.poses.size()); ++pose) {
      if (pose > 0) reach(pose);
      std::vector<cekf::Match> known;
      for (const auto& edge : graph_.landmark_edges) {
        if (edge.pose == pose) see(edge, known);
      }
      filter_.update(known);
      for (const auto& edge : graph_.fix_edges) {
        if (edge.pose != pose) continue;
        core::AbsoluteFix exact = edge.fix;
        exact.position_world_m = core::transform(at(pose), exact.antenna_robot_m);
        filter_.update_position(exact);
      }
      filter_.switch_region_if_due();
    }
    return std::move(filter_);
  }

 private:
  const core::Pose2& at(int pose) const { return graph_.poses[static_cast<std::size_t>(pose)].T_world_robot; }

  void reach(int pose) {
    core::Odometry exact;
    exact.T_before_after = core::between(at(pose - 1), at(pose));
    exact.covariance = graph_.pose_edges[static_cast<std::size_t>(pose - 1)].covariance;
    filter_.predict(exact);
  }

  void see(const core::LandmarkGraph::LandmarkEdge& edge, std::vector<cekf::Match>& known) {
    const core::LandmarkGraph::Landmark& landmark = graph_.landmarks[static_cast<std::size_t>(edge.landmark)];
    cekf::Match exact{static_cast<core::LandmarkId>(landmark.name), edge.observation, edge.T_robot_sensor};
    exact.observation.z =
        core::predict_observation(edge.observation.kind, at(edge.pose), edge.T_robot_sensor, landmark.point_m).z_hat;
    if (filter_.contains(exact.landmark)) {
      known.push_back(exact);
    } else {
      filter_.augment(exact.observation, exact.T_robot_sensor, exact.landmark);
    }
  }

  const core::LandmarkGraph& graph_;
  cekf::CompressedEkf filter_;
};

}  // namespace helixnav::supervisor
