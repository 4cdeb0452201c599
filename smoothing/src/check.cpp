// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/smoothing/problem.hpp"

namespace helixnav::smoothing {
namespace {

[[noreturn]] void fail(const std::string& what) { throw core::InputError("smoothing: " + what); }

void check_index(int index, std::size_t size, const std::string& what) {
  if (index < 0 || static_cast<std::size_t>(index) >= size) {
    fail(what + " has index " + std::to_string(index) + " but there are " + std::to_string(size));
  }
}

void check_covariance(const Eigen::Ref<const Eigen::MatrixXd>& covariance, const std::string& what) {
  if (!core::is_symmetric_positive_definite(covariance)) {
    fail("the covariance of " + what + " is not symmetric positive definite");
  }
}

/// Rows that involve each variable, which variables are tied to which, and what ties each part to the world.
/// Variables are counted poses first, then landmarks.
class Observability {
 public:
  explicit Observability(const Problem& problem)
      : problem_(problem),
        n_poses_(problem.graph.poses.size()),
        rows_(n_poses_ + problem.graph.landmarks.size(), 0),
        anchor_rows_(rows_.size(), 0),
        parent_(rows_.size()) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  std::size_t of_pose(int pose) const { return static_cast<std::size_t>(pose); }
  std::size_t of_landmark(int landmark) const { return n_poses_ + static_cast<std::size_t>(landmark); }

  void tie(std::size_t a, std::size_t b, int rows) {
    rows_[a] += rows;
    rows_[b] += rows;
    parent_[root(a)] = root(b);
  }

  void anchor(std::size_t a, int rows) {
    rows_[a] += rows;
    anchor_rows_[a] += rows;
  }

  void check() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const int unknowns = i < n_poses_ ? 3 : 2;
      if (rows_[i] == 0) fail(name(i) + " is not observed by any measurement");
      if (rows_[i] < unknowns) {
        fail(name(i) + " has " + std::to_string(unknowns) + " unknowns but only " + std::to_string(rows_[i]) +
             (rows_[i] == 1 ? " row of measurements" : " rows of measurements"));
      }
    }
    check_gauge();
  }

 private:
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  std::string name(std::size_t i) const {
    return i < n_poses_ ? pose_name(problem_, static_cast<int>(i))
                        : landmark_name(problem_, static_cast<int>(i - n_poses_));
  }

  void check_gauge() {
    std::vector<int> anchor_rows(rows_.size(), 0);
    std::vector<int> members(rows_.size(), 0);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      anchor_rows[root(i)] += anchor_rows_[i];
      ++members[root(i)];
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const std::size_t part = root(i);
      if (anchor_rows[part] < 3) {
        fail("no gauge: nothing fixes " + name(i) + " and the " + std::to_string(members[part] - 1) +
             " variables tied to it in the world; fix a pose or give a prior");
      }
    }
  }

  const Problem& problem_;
  std::size_t n_poses_;
  std::vector<int> rows_;
  std::vector<int> anchor_rows_;
  std::vector<std::size_t> parent_;
};

void check_values(const Problem& problem) {
  const core::LandmarkGraph& graph = problem.graph;
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    if (!graph.poses[i].T_world_robot.vector().allFinite()) {
      fail("the start of " + pose_name(problem, static_cast<int>(i)) + " is not finite");
    }
  }
  for (std::size_t i = 0; i < graph.landmarks.size(); ++i) {
    if (!graph.landmarks[i].point_m.allFinite()) {
      fail("the start of " + landmark_name(problem, static_cast<int>(i)) + " is not finite");
    }
  }
}

void check_pose_edges(const Problem& problem, Observability& observability) {
  const std::size_t n = problem.graph.poses.size();
  for (const auto& edge : problem.graph.pose_edges) {
    check_index(edge.from, n, "an odometry measurement's first pose");
    check_index(edge.to, n, "an odometry measurement's second pose");
    const std::string what =
        "the odometry from " + pose_name(problem, edge.from) + " to " + pose_name(problem, edge.to);
    if (edge.from == edge.to) fail(what + " ties a pose to itself");
    if (!edge.T_from_to.vector().allFinite()) fail(what + " is not finite");
    check_covariance(edge.covariance, what);
    observability.tie(observability.of_pose(edge.from), observability.of_pose(edge.to), 3);
  }
}

void check_landmark_edges(const Problem& problem, Observability& observability) {
  for (const auto& edge : problem.graph.landmark_edges) {
    check_index(edge.pose, problem.graph.poses.size(), "an observation's pose");
    check_index(edge.landmark, problem.graph.landmarks.size(), "an observation's landmark");
    try {
      core::check_observation(edge.observation);
    } catch (const core::PreconditionError& error) {
      fail(pose_name(problem, edge.pose) + " sees " + landmark_name(problem, edge.landmark) + ": " + error.what());
    }
    observability.tie(observability.of_pose(edge.pose), observability.of_landmark(edge.landmark),
                      core::dimension(edge.observation.kind));
  }
}

void check_anchors(const Problem& problem, Observability& observability) {
  for (const int pose : problem.fixed_poses) {
    check_index(pose, problem.graph.poses.size(), "a fixed pose");
    observability.anchor(observability.of_pose(pose), 3);
  }
  for (const PosePrior& prior : problem.pose_priors) {
    check_index(prior.pose, problem.graph.poses.size(), "a prior's pose");
    check_covariance(prior.covariance, "the prior of " + pose_name(problem, prior.pose));
    observability.anchor(observability.of_pose(prior.pose), 3);
  }
  for (const LandmarkPrior& prior : problem.landmark_priors) {
    check_index(prior.landmark, problem.graph.landmarks.size(), "a prior's landmark");
    check_covariance(prior.covariance_m2, "the prior of " + landmark_name(problem, prior.landmark));
    observability.anchor(observability.of_landmark(prior.landmark), 2);
  }
  for (const auto& edge : problem.graph.fix_edges) {
    check_index(edge.pose, problem.graph.poses.size(), "a fix's pose");
    const std::string what = "the fix at " + pose_name(problem, edge.pose);
    if (!edge.fix.position_world_m.allFinite()) fail(what + " is not finite");
    check_covariance(edge.fix.covariance_m2, what);
    observability.anchor(observability.of_pose(edge.pose), 2);
  }
}

}  // namespace

void check_problem(const Problem& problem) {
  if (problem.graph.poses.empty()) fail("there is no pose");
  check_values(problem);
  Observability observability(problem);
  check_pose_edges(problem, observability);
  check_landmark_edges(problem, observability);
  check_anchors(problem, observability);
  observability.check();
}

}  // namespace helixnav::smoothing
