// SPDX-License-Identifier: BSD-3-Clause
//
// Time of joining two forests that were mapped apart: helixnav_join_bench SMALL LARGE, numbers of landmarks. The larger
// session covers all that the smaller one does except for 20 m. Maps bend as odometry does: a random walk along rows 20 m
// apart, which the covariance models exactly.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include <Eigen/Cholesky>

#include "helixnav/core/random.hpp"
#include "helixnav/supervisor/join_sessions.hpp"

namespace {

using namespace helixnav;

constexpr double spacing_m = 5.0;  ///< one tree per square of this side
constexpr double wide_m = 120.0;
constexpr double row_m = 20.0;
constexpr double sigma_m = 0.05;

struct Tree {
  std::size_t number;
  Eigen::Vector2d at_m;
};

std::vector<Tree> forest(std::size_t trees) {
  core::RandomStream random(1, "forest");
  std::vector<Tree> all;
  const double long_m = static_cast<double>(trees) * spacing_m * spacing_m / wide_m;
  for (std::size_t i = 0; i < trees; ++i) {
    const double x_m = random.uniform(0.0, long_m);
    all.push_back({i, {x_m, random.uniform(0.0, wide_m)}});
  }
  return all;
}

/// Metres driven when the vehicle passes a tree: there and back along rows.
double driven_m(const Eigen::Vector2d& at_m) {
  const double row = std::floor(at_m.x() / row_m);
  const double along_m = std::fmod(row, 2.0) == 0.0 ? at_m.y() : wide_m - at_m.y();
  return row * (wide_m + row_m) + along_m;
}

/// A landmark's error is the random walk of the position, 1 cm/√m, at the metre where it was passed, plus its own.
core::JointMap mapped(const std::vector<Tree>& trees, const core::Pose2& T_world_session, std::uint64_t seed) {
  constexpr double walk_m = 0.01;
  core::RandomStream random(seed, "session");
  core::JointMap map;
  const auto n = static_cast<Eigen::Index>(trees.size());
  std::vector<double> metres{0.0};
  for (const Tree& tree : trees) metres.push_back(driven_m(tree.at_m) + 1.0);
  Eigen::MatrixXd walk(n + 1, n + 1);
  for (Eigen::Index i = 0; i <= n; ++i) {
    for (Eigen::Index j = 0; j <= n; ++j) {
      walk(i, j) = walk_m * walk_m * std::min(metres[static_cast<std::size_t>(i)], metres[static_cast<std::size_t>(j)]);
    }
  }
  walk.diagonal().array() += sigma_m * sigma_m;
  const Eigen::MatrixXd L = walk.llt().matrixL();
  Eigen::MatrixXd white(n + 1, 2);
  for (Eigen::Index i = 0; i < white.size(); ++i) white(i) = random.normal(0.0, 1.0);
  const Eigen::MatrixXd error_m = L * white;
  map.joint.covariance = Eigen::MatrixXd::Zero(3 + 2 * n, 3 + 2 * n);
  map.joint.covariance(2, 2) = 1e-4;
  for (int axis = 0; axis < 2; ++axis) {
    for (Eigen::Index i = 0; i <= n; ++i) {
      for (Eigen::Index j = 0; j <= n; ++j) {
        const auto row = [axis](Eigen::Index k) { return k == 0 ? axis : 1 + 2 * k + axis; };
        map.joint.covariance(row(i), row(j)) = walk(i, j);
      }
    }
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const Tree& tree = trees[static_cast<std::size_t>(i)];
    map.joint.ids.push_back(static_cast<core::LandmarkId>(tree.number));
    const Eigen::Vector2d seen_m = core::transform(core::inverse(T_world_session), tree.at_m);
    map.joint.points_m.push_back(seen_m + error_m.row(i + 1).transpose());
  }
  map.states.assign(trees.size(), core::LandmarkState::mature);
  map.observations.assign(trees.size(), 5);
  map.next_name = 100'000;
  map.reach_m = 20.0;
  return map;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t small = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 650;
  const std::size_t large = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 1155;
  const std::vector<Tree> all = forest(std::max(small, large));
  std::vector<Tree> part;
  for (const Tree& tree : all) {
    const double end_m = static_cast<double>(small) * spacing_m * spacing_m / wide_m;
    if (tree.at_m.x() < end_m) part.push_back(tree);
  }
  const std::vector<core::JointMap> maps{mapped(part, core::Pose2(30.0, -7.0, 2.0), 11),
                                         mapped(all, core::Pose2(), 12)};
  const std::clock_t begin = std::clock();
  const supervisor::JoinedSessions joined = supervisor::join_sessions(maps);
  const double processor_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  int wrong = 0, right = 0;
  for (const auto& [own, name] : joined.sessions[0].name_of) {
    for (const auto& [other, same] : joined.sessions[1].name_of) {
      if (name == same) ++(own == other ? right : wrong);
    }
  }
  const core::PlacedDecision& decision = joined.sessions[0].decision;
  std::printf(
      "%zu and %zu landmarks: %.1f s of processor time, %zu components, %d pairs right, %d wrong, cost %.1f of "
      "%.1f with %d\n",
      part.size(), all.size(), processor_s, joined.components.size(), right, wrong, decision.cost, decision.limit,
      decision.dof);
}
