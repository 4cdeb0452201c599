// SPDX-License-Identifier: BSD-3-Clause
#include "smoothing_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>

#include "helixnav/core/errors.hpp"
#include "helixnav/smoothing/marginals.hpp"
#include "helixnav/smoothing/residuals.hpp"

namespace helixnav::apps {

namespace {

constexpr std::size_t residuals_listed = 30;

std::size_t index(int i) { return static_cast<std::size_t>(i); }

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

/// [pose] its first step, −1 if it has none.
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

}  // namespace

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
