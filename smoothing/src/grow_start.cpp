// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/grow_start.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "session.hpp"

namespace helixnav::smoothing {
namespace {

using Graph = core::LandmarkGraph;

/// The problem restricted to its first poses and the landmarks that they fix.
struct Prefix {
  Problem problem;
  std::vector<int> landmarks;  ///< [index in the prefix] index in the whole
};

std::size_t as_index(int i) { return static_cast<std::size_t>(i); }

/// Rows needed beyond the two unknowns when no observation fixes the landmark alone.
constexpr int rows_to_spare = 2;

std::vector<char> landmarks_fixed_by(const Graph& graph, int n_poses) {
  std::vector<int> rows(graph.landmarks.size(), 0);
  std::vector<char> fixed(graph.landmarks.size(), 0);
  for (const auto& edge : graph.landmark_edges) {
    if (edge.pose >= n_poses) continue;
    const int dimension = core::dimension(edge.observation.kind);
    rows[as_index(edge.landmark)] += dimension;
    if (dimension == 2 || rows[as_index(edge.landmark)] >= 2 + rows_to_spare) fixed[as_index(edge.landmark)] = 1;
  }
  return fixed;
}

Prefix make_prefix(const Problem& whole, int n_poses) {
  Prefix prefix;
  const std::vector<char> fixed = landmarks_fixed_by(whole.graph, n_poses);
  std::vector<int> new_index(whole.graph.landmarks.size(), -1);
  Graph& graph = prefix.problem.graph;
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (!fixed[i]) continue;
    new_index[i] = static_cast<int>(prefix.landmarks.size());
    prefix.landmarks.push_back(static_cast<int>(i));
    graph.landmarks.push_back(whole.graph.landmarks[i]);
  }
  graph.poses.assign(whole.graph.poses.begin(), whole.graph.poses.begin() + n_poses);
  for (const auto& edge : whole.graph.pose_edges) {
    if (std::max(edge.from, edge.to) < n_poses) graph.pose_edges.push_back(edge);
  }
  for (const auto& edge : whole.graph.landmark_edges) {
    if (edge.pose >= n_poses || new_index[as_index(edge.landmark)] < 0) continue;
    graph.landmark_edges.push_back(edge);
    graph.landmark_edges.back().landmark = new_index[as_index(edge.landmark)];
  }
  for (const auto& edge : whole.graph.fix_edges) {
    if (edge.pose < n_poses) graph.fix_edges.push_back(edge);
  }
  for (const int pose : whole.fixed_poses) {
    if (pose < n_poses) prefix.problem.fixed_poses.push_back(pose);
  }
  for (const PosePrior& prior : whole.pose_priors) {
    if (prior.pose < n_poses) prefix.problem.pose_priors.push_back(prior);
  }
  for (LandmarkPrior prior : whole.landmark_priors) {
    prior.landmark = new_index[as_index(prior.landmark)];
    if (prior.landmark >= 0) prefix.problem.landmark_priors.push_back(prior);
  }
  return prefix;
}

/// [pose] the first edge that leads to it from a pose before it, or −1.
std::vector<int> edges_into(const Graph& graph) {
  std::vector<int> into(graph.poses.size(), -1);
  for (std::size_t i = 0; i < graph.pose_edges.size(); ++i) {
    const auto& edge = graph.pose_edges[i];
    if (edge.from < edge.to && into[as_index(edge.to)] < 0) into[as_index(edge.to)] = static_cast<int>(i);
  }
  return into;
}

/// Landmarks of the prefix that earlier stages have not placed go where its poses see them.
void place_new_landmarks(Prefix& prefix, std::vector<char>& placed, Graph& whole) {
  Graph located = prefix.problem.graph;
  core::locate_landmarks(located);
  for (std::size_t i = 0; i < prefix.landmarks.size(); ++i) {
    char& known = placed[as_index(prefix.landmarks[i])];
    if (!known) prefix.problem.graph.landmarks[i].point_m = located.landmarks[i].point_m;
    known = 1;
    whole.landmarks[as_index(prefix.landmarks[i])].point_m = prefix.problem.graph.landmarks[i].point_m;
  }
}

/// A few damped steps, without asking whether the stage has one solution: later stages may decide.
void solve_loosely(Prefix& prefix, Problem& whole) {
  Options options;
  options.max_iterations = 8;
  options.tolerance_chi2 = 1e-2;
  options.first_damping = 1e-8;
  options.ordering = Ordering::amd;
  Session session(prefix.problem, options);
  if (session.layout.columns == 0) return;
  levenberg_marquardt(session);
  for (std::size_t i = 0; i < session.state.poses.size(); ++i) {
    whole.graph.poses[i].T_world_robot = session.state.poses[i];
  }
  for (std::size_t i = 0; i < prefix.landmarks.size(); ++i) {
    whole.graph.landmarks[as_index(prefix.landmarks[i])].point_m = session.state.landmarks[i];
  }
}

}  // namespace

void grow_start(Problem& problem, int poses_per_stage) {
  if (poses_per_stage < 1) throw core::PreconditionError("grow_start: poses_per_stage must be at least 1");
  check_problem(problem);
  Problem grown = problem;
  const std::vector<int> into = edges_into(grown.graph);
  std::vector<char> placed(grown.graph.landmarks.size(), 0);
  const int n = static_cast<int>(grown.graph.poses.size());
  for (int done = 0; done < n;) {
    const int until = std::min(n, done + poses_per_stage);
    for (int pose = std::max(done, 1); pose < until; ++pose) {
      if (into[as_index(pose)] < 0) continue;
      const auto& edge = grown.graph.pose_edges[as_index(into[as_index(pose)])];
      grown.graph.poses[as_index(pose)].T_world_robot =
          core::compose(grown.graph.poses[as_index(edge.from)].T_world_robot, edge.T_from_to);
    }
    Prefix prefix = make_prefix(grown, until);
    place_new_landmarks(prefix, placed, grown.graph);
    solve_loosely(prefix, grown);
    done = until;
  }
  problem.graph = std::move(grown.graph);
}

}  // namespace helixnav::smoothing
