// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <variant>

#include <Eigen/Eigenvalues>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/merged_ids.hpp"
#include "helixnav/smoothing/marginals.hpp"
#include "helixnav/smoothing/residuals.hpp"

namespace helixnav::apps {

const Eigen::Vector3d rank_sigma{1e-3, 1e-3, 1e-4};

namespace {

/// Below this the smallest variance of an increment is rounding: (10 µm)², (10 µrad)².
constexpr double least_variance = 1e-10;
constexpr std::size_t residuals_listed = 30;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

void soften_rank_two(SmoothingTask& task) {
  for (const auto& edge : task.problem.graph.pose_edges) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(edge.covariance, Eigen::EigenvaluesOnly);
    const double least = eigen.eigenvalues().minCoeff();
    const double tiny = std::min(least_variance, 1e-9 * eigen.eigenvalues().maxCoeff());
    if (least >= tiny || least < -least_variance) continue;  // indefinite ones are the solver's to refuse
    smoothing::soften_odometry(task.problem, rank_sigma);
    task.softened_odometry = true;
    return;
  }
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

core::LandmarkId id_of(const smoothing::Problem& problem, int landmark) {
  const std::int64_t name = problem.graph.landmarks[index(landmark)].name;
  if (name < 0 || name > std::numeric_limits<core::LandmarkId>::max()) {
    throw core::InputError("landmark " + std::to_string(name) + ": expected a number from 0 to 2147483647");
  }
  return static_cast<core::LandmarkId>(name);
}

/// [edge of a landmark] residual at the values in the problem.
std::vector<smoothing::Residual> landmark_residuals(const smoothing::Problem& problem) {
  const auto& graph = problem.graph;
  std::vector<smoothing::Residual> by_edge(graph.landmark_edges.size());
  const std::size_t all = graph.pose_edges.size() + graph.landmark_edges.size() + graph.fix_edges.size();
  for (smoothing::Residual& residual : smoothing::largest_residuals(problem, all)) {
    if (residual.kind == smoothing::Residual::Kind::landmark) by_edge[index(residual.edge)] = std::move(residual);
  }
  return by_edge;
}

std::vector<core::MapLandmark> map_of(const smoothing::Problem& problem,
                                      const std::vector<Eigen::Matrix2d>& covariances) {
  std::vector<core::MapLandmark> map(problem.graph.landmarks.size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    map[i].id = id_of(problem, static_cast<int>(i));
    map[i].point.mean_m = problem.graph.landmarks[i].point_m;
    if (!covariances.empty()) map[i].point.covariance_m2 = covariances[i];
    map[i].state = core::LandmarkState::mature;
  }
  for (const auto& edge : problem.graph.landmark_edges) ++map[index(edge.landmark)].observations;
  return map;
}

/// [pose] its first step, −1 when it has none.
std::vector<std::int64_t> step_of_pose(const SmoothingTask& task) {
  std::vector<std::int64_t> step(task.problem.graph.poses.size(), -1);
  for (std::size_t k = task.pose_of_step.size(); k-- > 0;) {
    step[index(task.pose_of_step[k])] = static_cast<std::int64_t>(k);
  }
  return step;
}

void report_residuals(const SmoothingTask& task, runs::SmoothedRun& run) {
  const std::vector<std::int64_t> step = step_of_pose(task);
  for (const auto& residual : smoothing::largest_residuals(task.problem, residuals_listed)) {
    run.largest.push_back(
        {step[index(residual.pose)], residual.name, residual.nis, static_cast<int>(residual.e.size())});
  }
  for (const auto& residual : landmark_residuals(task.problem)) {
    const auto& R = task.problem.graph.landmark_edges[index(residual.edge)].observation.R;
    for (Eigen::Index row = 0; row < residual.e.size(); ++row) {
      run.normalised_residuals.push_back({step[index(residual.pose)], residual.e(row) / std::sqrt(R(row, row))});
    }
  }
  std::stable_sort(run.normalised_residuals.begin(), run.normalised_residuals.end(),
                   [](const auto& a, const auto& b) { return a.step < b.step; });
}

std::vector<std::pair<std::string, double>> numbers_of(const smoothing::Report& report) {
  return {{"chi2", report.chi2.total()},
          {"dof", report.dof},
          {"chi2_by_kind.odometry", report.chi2.odometry},
          {"chi2_by_kind.landmarks", report.chi2.landmarks},
          {"chi2_by_kind.priors", report.chi2.priors},
          {"chi2_start", report.start.total()},
          {"iterations", static_cast<double>(report.iterations.size())},
          {"converged", report.reason == smoothing::Reason::converged ? 1.0 : 0.0}};
}

/// [landmark of the task] the run's landmark that shares most observations with it.
std::vector<core::LandmarkId> partners_in_run(const SmoothingTask& task, const std::vector<core::StepReport>& steps) {
  const core::MergedIds ids(steps);
  std::vector<std::map<core::LandmarkId, int>> votes(task.problem.graph.landmarks.size());
  for (std::size_t k = 0; k < steps.size(); ++k) {
    for (const core::AssociationReport& a : steps[k].associations) {
      const bool counts = a.outcome == core::Outcome::matched || a.outcome == core::Outcome::augmented;
      if (!counts || index(a.observation) >= task.edge_of[k].size()) continue;
      const int edge = task.edge_of[k][index(a.observation)];
      if (edge < 0) continue;
      ++votes[index(task.problem.graph.landmark_edges[index(edge)].landmark)][ids.now(a.landmark)];
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
    task.edge_of[index(graph.landmark_edges[i].pose)].push_back(static_cast<int>(i));
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
      if (settled && index(a.observation) < here.size()) here[index(a.observation)] = merged.now(a.landmark);
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
  for (std::size_t k = 0; k < poses.size(); ++k) graph.poses[index(task.pose_of_step[k])].T_world_robot = poses[k];
  core::locate_landmarks(graph);
  std::map<core::LandmarkId, Eigen::Vector2d> point_of;
  for (const core::MapLandmark& landmark : map) point_of[landmark.id] = landmark.point.mean_m;
  const std::vector<core::LandmarkId> partners = partners_in_run(task, steps);
  for (std::size_t i = 0; i < partners.size(); ++i) {
    const auto known = point_of.find(partners[i]);
    if (known != point_of.end()) graph.landmarks[i].point_m = known->second;
  }
}

SmoothingResult solve(SmoothingTask& task, const smoothing::SmoothOptions& options) {
  SmoothingResult result;
  result.started = task.problem;
  const auto begin = std::chrono::steady_clock::now();
  result.report = smoothing::smooth(task.problem, options);
  result.solving_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  result.numbers = numbers_of(result.report);
  for (const int pose : task.pose_of_step) {
    result.run.poses_before.push_back(result.started.graph.poses[index(pose)].T_world_robot);
    result.run.poses.push_back(task.problem.graph.poses[index(pose)].T_world_robot);
  }
  result.run.chi2_odometry = result.report.chi2.odometry;
  result.run.chi2_landmarks = result.report.chi2.landmarks;
  result.run.dof = result.report.dof;
  result.run.map_before = map_of(result.started, {});
  result.run.map_after = map_of(task.problem, smoothing::landmark_covariances(task.problem));
  result.run.chi2.push_back(result.report.start.total());
  for (const auto& iteration : result.report.iterations) result.run.chi2.push_back(iteration.chi2.total());
  report_residuals(task, result.run);
  return result;
}

std::vector<core::StepReport> steps_of(const SmoothingTask& task, const smoothing::Problem& problem) {
  const std::vector<smoothing::Residual> residuals = landmark_residuals(problem);
  std::vector<core::StepReport> steps(task.times.size());
  for (std::size_t k = 0; k < steps.size(); ++k) {
    steps[k].step = static_cast<std::int64_t>(k);
    steps[k].t_ns = task.times[k];
    steps[k].pose.mean = problem.graph.poses[index(task.pose_of_step[k])].T_world_robot;
    steps[k].mapped_landmarks = static_cast<int>(problem.graph.landmarks.size());
    for (std::size_t i = 0; i < task.edge_of[k].size(); ++i) {
      core::AssociationReport a;
      a.observation = static_cast<int>(i);
      a.outcome = core::Outcome::rejected;
      a.nis = std::numeric_limits<double>::quiet_NaN();
      a.margin_nats = std::numeric_limits<double>::infinity();
      if (const int edge = task.edge_of[k][i]; edge >= 0) {
        a.outcome = core::Outcome::matched;
        a.landmark = id_of(problem, residuals[index(edge)].landmark);
        a.nis = residuals[index(edge)].nis;
        a.dof = static_cast<int>(residuals[index(edge)].e.size());
      }
      steps[k].associations.push_back(a);
    }
  }
  return steps;
}

std::string text_of(const SmoothingTask& task, const SmoothingResult& result) {
  const smoothing::Report& report = result.report;
  const core::LandmarkGraph& graph = task.problem.graph;
  char text[1024];
  std::snprintf(text, sizeof text,
                "poses %zu, landmarks %zu, observations %zu (left out: %d without label, %d landmarks not located)\n"
                "chi2 %.2f -> %.2f (odometry %.2f, landmarks %.2f, priors and fixes %.2f)\n"
                "degrees of freedom %d, overconfidence factor chi2/dof %.3f\n"
                "%zu iterations, %s, %.3f s\n",
                graph.poses.size(), graph.landmarks.size(), graph.landmark_edges.size(), task.unlabelled_observations,
                task.unlocated_landmarks, report.start.total(), report.chi2.total(), report.chi2.odometry,
                report.chi2.landmarks, report.chi2.priors, report.dof,
                report.dof > 0 ? report.chi2.total() / report.dof : 0.0, report.iterations.size(),
                smoothing::to_string(report.reason).c_str(), result.solving_s);
  std::string all = text;
  if (task.softened_odometry) {
    all += "odometry of rank two: 1 mm, 1 mm, 0.1 mrad were added to the noise of every increment\n";
  }
  return all;
}

}  // namespace helixnav::apps
