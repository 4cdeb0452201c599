// SPDX-License-Identifier: BSD-3-Clause
#include "solve.hpp"

#include <utility>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/smoothing/minimum.hpp"
#include "process.hpp"

namespace helixnav::team {
namespace {

/// x, y, heading [m, m, rad]: added to covariances that may have no inverse, well below any noise of a robot.
const Eigen::Vector3d softening(2e-5, 2e-5, 2e-6);

/// The rows of one component as a least-squares problem.
class ComponentGraph {
 public:
  ComponentGraph(const Component& component, const State& state)
      : component_(component), state_(state), first_pose_(state.robots.size(), -1) {
    add_poses();
    add_start();
    add_landmarks();
    add_sightings();
  }

  smoothing::Problem problem;

  int pose(std::size_t robot, std::size_t clone) const { return first_pose_[robot] + static_cast<int>(clone); }
  int last_pose(std::size_t robot) const { return pose(robot, state_.robots[robot].clones.size() - 1); }
  bool has(std::size_t robot) const { return first_pose_[robot] >= 0; }

 private:
  void add_poses() {
    core::LandmarkGraph& graph = problem.graph;
    for (const std::size_t r : component_.robots) {
      first_pose_[r] = static_cast<int>(graph.poses.size());
      for (const Clone& clone : state_.robots[r].clones) {
        const int index = static_cast<int>(graph.poses.size());
        graph.poses.push_back({index, clone.T_component_robot});
        if (index > first_pose_[r]) {
          graph.pose_edges.push_back({index - 1, index, clone.motion.T_before_after, clone.motion.covariance});
        }
      }
    }
    smoothing::soften_odometry(problem, softening);
  }

  /// If no start is known, the first robot's is the frame.
  void add_start() {
    const Eigen::Matrix3d certain = softening.cwiseAbs2().asDiagonal();
    for (const std::size_t r : component_.robots) {
      const std::optional<core::PoseGaussian>& start = state_.robots[r].start;
      if (start) problem.pose_priors.push_back({first_pose_[r], start->mean, start->covariance + certain});
    }
    if (!problem.pose_priors.empty()) return;
    problem.pose_priors.push_back({first_pose_[component_.robots.front()], core::Pose2(), certain});
  }

  void add_landmarks() {
    core::LandmarkGraph& graph = problem.graph;
    std::vector<int> index_of(state_.merged_into.size(), -1);
    for (std::size_t i = 0; i < component_.filter.ids().size(); ++i) {
      const core::LandmarkId id = component_.filter.ids()[i];
      index_of[static_cast<std::size_t>(id)] = static_cast<int>(graph.landmarks.size());
      graph.landmarks.push_back({id, component_.filter.points_m()[i]});
    }
    for (const LandmarkRow& row : state_.landmark_rows) {
      if (!has(row.robot)) continue;
      const int landmark = index_of[static_cast<std::size_t>(state_.resolve(row.landmark))];
      graph.landmark_edges.push_back({pose(row.robot, row.clone), landmark, row.T_clone_sensor, row.observation});
    }
  }

  /// A sighting is a position; it says nothing about the heading of the robot seen.
  void add_sightings() {
    constexpr double any_heading_rad2 = 1e6;
    for (const SightingRow& row : state_.sighting_rows) {
      if (row.use != SightingRow::Use::used || !has(row.robot)) continue;
      const SeenPosition seen = seen_position(row.T_robot_sensor, row.observation);
      core::LandmarkGraph::PoseEdge edge;
      edge.from = pose(row.robot, row.clone);
      edge.to = pose(row.seen, row.seen_clone);
      edge.T_from_to = core::Pose2(seen.position_m.x(), seen.position_m.y(), 0.0);
      edge.covariance.topLeftCorner<2, 2>() = seen.covariance_m2;
      edge.covariance(2, 2) = any_heading_rad2;
      problem.graph.pose_edges.push_back(edge);
    }
  }

  const Component& component_;
  const State& state_;
  std::vector<int> first_pose_;
};

smoothing::Options from_a_good_start(int most_iterations) {
  smoothing::Options options;
  options.max_iterations = most_iterations;
  options.first_damping = 1e-8;
  options.ordering = smoothing::Ordering::amd;
  options.tolerance_chi2 = 1e-4;
  return options;
}

JointFilter filter_at(const smoothing::Minimum& minimum, const ComponentGraph& graph, const Component& component) {
  std::vector<int> poses;
  std::vector<core::Pose2> at;
  for (const std::size_t r : component.robots) {
    poses.push_back(graph.last_pose(r));
    at.push_back(graph.problem.graph.poses[static_cast<std::size_t>(poses.back())].T_world_robot);
  }
  std::vector<int> landmarks;
  std::vector<core::LandmarkId> ids;
  std::vector<Eigen::Vector2d> points_m;
  for (const core::LandmarkGraph::Landmark& landmark : graph.problem.graph.landmarks) {
    landmarks.push_back(static_cast<int>(landmarks.size()));
    ids.push_back(static_cast<core::LandmarkId>(landmark.name));
    points_m.push_back(landmark.point_m);
  }
  return {at, ids, points_m, minimum.joint_covariance(poses, landmarks)};
}

}  // namespace

SeenPosition seen_position(const core::Pose2& T_robot_sensor, const core::Observation& observation) {
  const core::LocatedLandmark located = core::locate_landmark(observation, core::Pose2(), T_robot_sensor);
  const Eigen::Matrix2d covariance = located.G_z * observation.R * located.G_z.transpose();
  return {located.point_world_m, 0.5 * (covariance + covariance.transpose())};
}

namespace {

bool minimise(Component& solved, State& state, int most_iterations) {
  ComponentGraph graph(solved, state);
  const smoothing::Minimum minimum(graph.problem, from_a_good_start(most_iterations));
  if (minimum.report().reason != smoothing::Reason::converged) return false;
  solved.filter = filter_at(minimum, graph, solved);
  solved.chi2 = minimum.report().chi2.total();
  solved.news = false;
  for (const std::size_t r : solved.robots) {
    for (std::size_t k = 0; k < state.robots[r].clones.size(); ++k) {
      state.robots[r].clones[k].T_component_robot =
          graph.problem.graph.poses[static_cast<std::size_t>(graph.pose(r, k))].T_world_robot;
    }
  }
  return true;
}

}  // namespace

bool solve(std::size_t component, State& state, int most_iterations) {
  Component& solved = state.components[component];
  for (const std::size_t r : solved.robots) clone_now(r, state);
  try {
    return minimise(solved, state, most_iterations);
  } catch (const core::NumericalError&) {
    return false;  // e.g. an iterate that puts a landmark into the sensor: the filter goes on, and the next solution may succeed
  }
}

}  // namespace helixnav::team
