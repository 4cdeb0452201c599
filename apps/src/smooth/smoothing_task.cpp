// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing_task.hpp"

#include <algorithm>
#include <map>
#include <variant>

#include <Eigen/Eigenvalues>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/merged_ids.hpp"

namespace helixnav::apps {

const Eigen::Vector3d rank_sigma{1e-3, 1e-3, 1e-4};

namespace {

/// Below this the smallest variance of an increment is rounding: (10 µm)², (10 µrad)².
constexpr double least_variance = 1e-10;

/// A stationary vehicle, if noise is per distance, is where it was up to rounding: with more than that a long stop would
/// drift, and count as odometry that is better than assumed.
bool stands(const core::LandmarkGraph::PoseEdge& edge) {
  return edge.T_from_to.position_m().squaredNorm() < least_variance &&
         edge.covariance.cwiseAbs().maxCoeff() < least_variance;
}

/// If motion is certain in one direction, it is softened, and then the whole drive, so that its noise is of one kind.
void soften_rank_two(SmoothingTask& task) {
  bool moves = false;
  for (auto& edge : task.problem.graph.pose_edges) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(edge.covariance, Eigen::EigenvaluesOnly);
    const double least = eigen.eigenvalues().minCoeff();
    if (least < -least_variance) continue;  // the solver refuses indefinite ones
    if (stands(edge)) {
      edge.covariance.diagonal().array() += least_variance;
    } else {
      moves = moves || least <= 0.0 || least < std::min(least_variance, 1e-9 * eigen.eigenvalues().maxCoeff());
    }
  }
  if (!moves) return;
  smoothing::soften_odometry(task.problem, rank_sigma);
  task.softened_odometry = true;
}

void fill_edges(const core::Recording& recording, const Ids& ids, SmoothingTask& task) {
  std::map<std::int64_t, bool> located;
  for (const auto& landmark : task.problem.graph.landmarks) located[landmark.name] = true;
  int edge = 0;
  for (const core::Event& event : recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    task.times.push_back(scan->t_ns);
    std::vector<int>& edges = task.edge_of.emplace_back();
    for (const std::int64_t id : ids[task.edge_of.size() - 1]) {
      edges.push_back(id >= 0 && located.count(id) > 0 ? edge++ : -1);
    }
  }
}

/// [landmark of the task] the run's landmark that shares most observations with it.
std::vector<core::LandmarkId> partners_in_run(const SmoothingTask& task, const std::vector<core::StepReport>& steps) {
  const core::MergedIds ids(steps);
  std::vector<std::map<core::LandmarkId, int>> votes(task.problem.graph.landmarks.size());
  for (std::size_t k = 0; k < steps.size(); ++k) {
    for (const core::AssociationReport& a : steps[k].associations) {
      const bool counts = a.outcome == core::Outcome::matched || a.outcome == core::Outcome::augmented;
      if (!counts || at(a.observation) >= task.edge_of[k].size()) continue;
      const int edge = task.edge_of[k][at(a.observation)];
      if (edge < 0) continue;
      ++votes[at(task.problem.graph.landmark_edges[at(edge)].landmark)][ids.now(a.landmark)];
    }
  }
  std::vector<core::LandmarkId> partners;
  for (const auto& of_landmark : votes) {
    const auto most = std::max_element(of_landmark.begin(), of_landmark.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    partners.push_back(most == of_landmark.end() ? core::no_landmark : most->first);
  }
  return partners;
}

}  // namespace

SmoothingTask task_from_recording(const core::Recording& recording, const Ids& ids) {
  SmoothingTask task;
  core::GraphFromEvents made = core::graph_from_events(recording.events, ids, recording.start.mean);
  task.unlabelled_observations = made.unlabelled_observations;
  task.unlocated_landmarks = made.unlocated_landmarks;
  task.pose_of_step = std::move(made.pose_of_scan);
  task.problem = smoothing::problem_from_graph(std::move(made.graph));
  fill_edges(recording, ids, task);
  soften_rank_two(task);
  return task;
}

SmoothingTask task_from_graph(core::LandmarkGraph graph) {
  SmoothingTask task;
  task.edge_of.resize(graph.poses.size());
  for (std::size_t k = 0; k < graph.poses.size(); ++k) {
    task.times.push_back(core::nanoseconds_from_seconds(static_cast<double>(k)));
    task.pose_of_step.push_back(static_cast<int>(k));
  }
  for (std::size_t i = 0; i < graph.landmark_edges.size(); ++i) {
    task.edge_of[at(graph.landmark_edges[i].pose)].push_back(static_cast<int>(i));
  }
  task.problem = smoothing::problem_from_graph(std::move(graph));
  return task;
}

Ids ids_of_run(const std::vector<core::StepReport>& steps, const core::Recording& recording) {
  const core::MergedIds merged(steps);
  Ids ids;
  for (const core::Event& event : recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    std::vector<std::int64_t>& here = ids.emplace_back(scan->observations.size(), -1);
    if (ids.size() > steps.size()) continue;
    for (const core::AssociationReport& a : steps[ids.size() - 1].associations) {
      const bool settled = a.outcome == core::Outcome::matched || a.outcome == core::Outcome::augmented;
      if (settled && at(a.observation) < here.size()) here[at(a.observation)] = merged.now(a.landmark);
    }
  }
  return ids;
}

void start_from_run(const std::string& name, const std::vector<core::StepReport>& steps,
                    const std::vector<core::Pose2>& poses, const std::vector<core::MapLandmark>& map,
                    SmoothingTask& task) {
  if (steps.size() != task.times.size() || poses.size() != steps.size()) {
    throw core::InputError(name + ": a run of " + std::to_string(steps.size()) + " steps, expected one of this log's " +
                           std::to_string(task.times.size()));
  }
  core::LandmarkGraph& graph = task.problem.graph;
  for (std::size_t k = 0; k < poses.size(); ++k) graph.poses[at(task.pose_of_step[k])].T_world_robot = poses[k];
  core::locate_landmarks(graph);
  std::map<core::LandmarkId, Eigen::Vector2d> point_of;
  for (const core::MapLandmark& landmark : map) point_of[landmark.id] = landmark.point.mean_m;
  const std::vector<core::LandmarkId> partners = partners_in_run(task, steps);
  for (std::size_t i = 0; i < partners.size(); ++i) {
    const auto known = point_of.find(partners[i]);
    if (known != point_of.end()) graph.landmarks[i].point_m = known->second;
  }
}

}  // namespace helixnav::apps
