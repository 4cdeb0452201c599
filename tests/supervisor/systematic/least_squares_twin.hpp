// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "helixnav/core/landmark_graph.hpp"
#include "helixnav/core/observation.hpp"
#include "helixnav/smoothing/constants.hpp"
#include "helixnav/smoothing/optimize.hpp"
#include "helixnav/supervisor/systematic_errors.hpp"
#include "loop/tape.hpp"
#include "smoothing/drive_phases.hpp"

namespace helixnav::supervisor {

/// The stretch as a problem of least squares, without the landmarks that were seen once. It begins at `near`, a pose for each stop, or at dead reckoning.
inline smoothing::Problem problem_of(const std::vector<Stop>& stops, const std::vector<core::Pose2>& near = {}) {
  std::map<core::LandmarkId, std::vector<std::pair<int, const cekf::Match*>>> seen;
  core::LandmarkGraph graph;
  for (std::size_t k = 0; k < stops.size(); ++k) {
    const auto pose = static_cast<int>(k);
    core::Pose2 T_world_robot;
    if (k > 0) {
      core::LandmarkGraph::PoseEdge edge{pose - 1, pose, stops[k].motion->T_before_after, stops[k].motion->covariance};
      edge.covariance.diagonal() += softening().cwiseAbs2();
      T_world_robot = core::compose(graph.poses.back().T_world_robot, edge.T_from_to);
      graph.pose_edges.push_back(edge);
    }
    if (!near.empty()) T_world_robot = core::between(near.front(), near[k]);
    graph.poses.push_back({pose, T_world_robot});
    for (const cekf::Match& match : stops[k].seen) seen[match.landmark].emplace_back(pose, &match);
  }
  for (const auto& [id, sightings] : seen) {
    if (sightings.size() < 2) continue;
    const auto& [first, match] = sightings.front();
    const auto at = core::locate_landmark(
        match->observation, graph.poses[static_cast<std::size_t>(first)].T_world_robot, match->T_robot_sensor);
    const auto landmark = static_cast<int>(graph.landmarks.size());
    graph.landmarks.push_back({id, at.point_world_m});
    for (const auto& [pose, sighting] : sightings) {
      graph.landmark_edges.push_back({pose, landmark, sighting->T_robot_sensor, sighting->observation});
    }
  }
  return smoothing::problem_from_graph(std::move(graph));
}

/// The errors as constants of that problem. A missing range acts like a sensor that is nearer to what it sees.
inline std::vector<smoothing::ConstantDerivative> constants_of(const smoothing::Problem& problem,
                                                               const std::vector<Stop>& stops) {
  std::vector<smoothing::ConstantDerivative> constants(SystematicErrors::count);
  for (const auto& edge : problem.graph.pose_edges) {
    const auto to = static_cast<std::size_t>(edge.to);
    const auto J = derivative_without_errors(edge.T_from_to, core::seconds(stops[to].t_ns - stops[to - 1].t_ns));
    for (std::size_t c = 0; c < constants.size(); ++c) {
      constants[c].increments.push_back(J.col(static_cast<Eigen::Index>(c)));
    }
  }
  for (const auto& edge : problem.graph.landmark_edges) {
    const core::Pose2 T_world_sensor =
        core::compose(problem.graph.poses[static_cast<std::size_t>(edge.pose)].T_world_robot, edge.T_robot_sensor);
    const Eigen::Vector2d seen_m = core::transform(
        core::inverse(T_world_sensor), problem.graph.landmarks[static_cast<std::size_t>(edge.landmark)].point_m);
    const Eigen::Vector2d towards = core::rotation(edge.T_robot_sensor.heading_rad) * seen_m.normalized();
    for (auto& constant : constants) constant.mountings.emplace_back(Eigen::Vector3d::Zero());
    constants[3].mountings.back().z() = 1.0;
    constants[4].mountings.back() << towards, 0.0;
  }
  return constants;
}

}  // namespace helixnav::supervisor
