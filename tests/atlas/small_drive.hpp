// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include "helixnav/atlas/atlas.hpp"
#include "helixnav/core/landmark_graph.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/smoothing/optimize.hpp"
#include "helixnav/smoothing/problem.hpp"

namespace helixnav::atlas::testing {

/// A drive in rounds on a circle among landmarks, cut into phases; the same measurements as one least-squares problem.
struct SmallDrive {
  std::vector<std::shared_ptr<PhaseLog>> logs;
  smoothing::Problem problem;      ///< pose 0 fixed at the origin; landmark i has name i
  std::vector<int> pose_of_clone;  ///< index in the problem
  std::vector<core::Pose2> truth;
};

struct SmallDriveOptions {
  int steps = 96;
  int steps_per_phase = 8;
  int landmarks = 30;
  double rounds = 2.0;
  double radius_m = 25.0;
  double reach_m = 12.0;
  double noise = 1.0;     ///< multiple of the assumed sigmas
  double bare_rad = 0.0;  ///< arc of the circle, from its beginning, without landmarks
};

inline core::Observation noisy_view(const core::Pose2& T_world_robot, const Eigen::Vector2d& point_m, double noise,
                                    core::RandomStream& random) {
  const Eigen::Vector2d seen_m = core::transform(core::inverse(T_world_robot), point_m);
  core::Observation observation =
      core::make_range_bearing(seen_m.norm(), std::atan2(seen_m.y(), seen_m.x()), 0.1, 0.01);
  observation.z[0] += noise * random.normal(0.0, 0.1);
  observation.z[1] = core::wrap_to_pi(observation.z[1] + noise * random.normal(0.0, 0.01));
  return observation;
}

inline SmallDrive make_small_drive(std::uint64_t seed, const SmallDriveOptions& o = {}) {
  core::RandomStream random(seed);
  SmallDrive drive;
  core::LandmarkGraph& graph = drive.problem.graph;
  std::vector<Eigen::Vector2d> points_m;
  for (int i = 0; i < o.landmarks; ++i) {
    const double angle_rad = o.bare_rad + (2.0 * core::pi - o.bare_rad) * (i + random.uniform(0.0, 1.0)) / o.landmarks;
    const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
    const double r_m = o.radius_m + side * random.uniform(2.0, 6.0);
    points_m.emplace_back(r_m * std::sin(angle_rad), o.radius_m - r_m * std::cos(angle_rad));
  }
  const double turn_rad = 2.0 * core::pi * o.rounds / o.steps;
  const core::Pose2 step(o.radius_m * std::sin(turn_rad), o.radius_m * (1.0 - std::cos(turn_rad)), turn_rad);
  const Eigen::Vector3d sigma(0.05, 0.03, 0.01);
  std::map<int, int> index_of;  // landmark → index in the graph
  core::Pose2 T_world_robot;
  drive.pose_of_clone.push_back(0);
  for (int k = 0; k <= o.steps; ++k) {
    LoggedStep logged;
    if (k > 0) {
      T_world_robot = core::compose(T_world_robot, step);
      const Eigen::Vector3d error = random.normal3(sigma.cwiseAbs2().asDiagonal());
      logged.T_before_after = core::Pose2(Eigen::Vector3d(step.vector() + o.noise * error));
      logged.covariance = sigma.cwiseAbs2().asDiagonal();
      if ((k - 1) % o.steps_per_phase == 0) drive.logs.push_back(std::make_shared<PhaseLog>());
      graph.pose_edges.push_back({k - 1, k, logged.T_before_after, logged.covariance});
    }
    graph.poses.push_back({k, T_world_robot});
    for (int i = 0; i < o.landmarks; ++i) {
      if ((points_m[static_cast<std::size_t>(i)] - T_world_robot.position_m()).norm() > o.reach_m) continue;
      const auto& point_m = points_m[static_cast<std::size_t>(i)];
      logged.seen.push_back({i, core::Pose2(), noisy_view(T_world_robot, point_m, o.noise, random)});
      const auto [place, is_new] = index_of.try_emplace(i, static_cast<int>(graph.landmarks.size()));
      if (is_new) graph.landmarks.push_back({i, point_m});
      graph.landmark_edges.push_back({k, place->second, core::Pose2(), logged.seen.back().observation});
    }
    if (k > 0) {
      drive.logs.back()->steps.push_back(logged);
      if (k % o.steps_per_phase == 0 || k == o.steps) drive.pose_of_clone.push_back(k);
    }
    if (k == 1) {  // what was seen from the start belongs to the first phase
      for (const auto& edge : graph.landmark_edges) {
        if (edge.pose != 0) continue;
        const auto name = static_cast<core::LandmarkId>(graph.landmarks[static_cast<std::size_t>(edge.landmark)].name);
        drive.logs.back()->seen_at_entry.push_back({name, edge.T_robot_sensor, edge.observation});
      }
    }
    drive.truth.push_back(T_world_robot);
  }
  drive.problem.fixed_poses = {0};
  return drive;
}

/// Adds the phases of a drive as a navigator would: each derived with the atlas's knowledge of its landmarks as a prior.
inline void add_phase(Atlas& atlas, const std::shared_ptr<PhaseLog>& log) {
  std::vector<core::LandmarkId> known;
  for (const core::LandmarkId id : landmarks_of(*log)) {
    if (atlas.knows(id)) known.push_back(id);
  }
  if (known.empty()) {
    atlas.add(derive_factor(*log, dead_reckon(*log)), log);
  } else {
    const PointPrior prior = relative_to_pose(atlas.joint(known));
    atlas.add(derive_factor(*log, dead_reckon(*log, &prior), &prior), log);
  }
  atlas.settle();
}

/// Relinearises everything until nothing moves: the optimum.
inline Options exact() {
  Options options;
  options.bend_m = 0.0;
  options.rederive_m = 0.0;
  options.rederive_rad = 0.0;
  return options;
}

inline Atlas driven(const SmallDrive& drive, const Options& options = exact()) {
  Atlas atlas({}, options);
  for (const auto& log : drive.logs) add_phase(atlas, log);
  return atlas;
}

/// χ² of the optimum; moves the problem's values there.
inline double solve(smoothing::Problem& problem) {
  smoothing::Options options;
  options.first_damping = 1e-12;  // equivalent to Gauss-Newton, whose last step goes far beyond its tolerance
  options.tolerance_chi2 = 1e-12;
  smoothing::optimize(problem, options);
  return smoothing::optimize(problem, options).chi2.total();
}

}  // namespace helixnav::atlas::testing
