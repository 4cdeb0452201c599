// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/fastslam/path_tree.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "small_drives.hpp"

namespace helixnav::fastslam {
namespace {

/// Back from the end of a path: its steps and places, latest first.
std::vector<Eigen::Vector3d> path_to(const std::vector<core::PathPoint>& points, std::size_t end) {
  std::vector<Eigen::Vector3d> path;
  for (auto at = static_cast<std::ptrdiff_t>(end); at >= 0; at = points[static_cast<std::size_t>(at)].before) {
    const core::PathPoint& point = points[static_cast<std::size_t>(at)];
    path.emplace_back(static_cast<double>(point.step), point.T_world_robot.x_m, point.T_world_robot.y_m);
  }
  return path;
}

TEST(PathTree, HoldsThePathsThatEachParticleWouldKeepWhole) {
  constexpr std::size_t particles = 40;
  core::RandomStream random(5, "path tree");
  PathTree tree;
  std::vector<std::vector<Eigen::Vector3d>> kept(particles);  // [particle] in the form of path_to
  for (int step = 0; step < 900; ++step) {
    if (random.bernoulli(0.2)) {
      std::vector<std::uint32_t> parents;
      for (std::size_t k = 0; k < particles; ++k)
        parents.push_back(static_cast<std::uint32_t>(random.below(particles)));
      tree.descend(parents);
      std::vector<std::vector<Eigen::Vector3d>> children;
      for (const std::uint32_t parent : parents) children.push_back(kept[parent]);
      kept = children;
    }
    if (!random.bernoulli(0.7)) continue;
    std::vector<core::Pose2> poses;
    for (std::size_t k = 0; k < particles; ++k) poses.emplace_back(random.normal(), random.normal(), 0.0);
    tree.mark(step, poses);
    for (std::size_t k = 0; k < particles; ++k)
      kept[k].insert(kept[k].begin(), {double(step), poses[k].x_m, poses[k].y_m});
  }
  const std::vector<core::PathPoint> points = tree.points(std::vector<double>(particles, 1.0 / particles));
  EXPECT_LT(points.size(), 4000u) << "dead paths are kept";
  std::vector<std::size_t> ends;
  std::vector<bool> goes_on(points.size(), false);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_LT(points[i].before, static_cast<std::ptrdiff_t>(i));
    if (points[i].before >= 0) goes_on[static_cast<std::size_t>(points[i].before)] = true;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!goes_on[i]) ends.push_back(i);
  }
  std::sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.front()[1] < b.front()[1]; });
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  std::sort(ends.begin(), ends.end(),
            [&](std::size_t a, std::size_t b) { return points[a].T_world_robot.x_m < points[b].T_world_robot.x_m; });
  ASSERT_EQ(ends.size(), kept.size());
  for (std::size_t k = 0; k < ends.size(); ++k) EXPECT_EQ(path_to(points, ends[k]), kept[k]) << k;
  EXPECT_NEAR(points.front().share, 1.0, 1e-12) << "all paths have joined there";
}

TEST(PathTree, SharesAreTheWeightsOfThePathsOverAPoint) {
  PathTree tree;
  tree.mark(0, {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}});
  tree.descend({0, 0, 2});
  tree.mark(1, {{0.0, 1.0, 0.0}, {0.1, 1.0, 0.0}, {2.0, 1.0, 0.0}});
  const std::vector<core::PathPoint> points = tree.points({0.2, 0.3, 0.5});
  ASSERT_EQ(points.size(), 5u);
  const std::vector<double> expected{0.5, 0.5, 0.2, 0.3, 0.5};
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_DOUBLE_EQ(points[i].share, expected[i]) << i;
  EXPECT_THROW(tree.points({1.0}), core::PreconditionError);
  EXPECT_THROW(tree.mark(2, {{0.0, 0.0, 0.0}}), core::PreconditionError);
}

TEST(Mixture, IsTheWeightedMixtureOfTheMapsOfAllParticles) {
  Options options;
  options.particles = 30;
  options.resample_below = 0.1;  // weights that differ
  FastSlam slam(core::PoseGaussian{}, options, 4);
  for (const test::Stage& stage : test::drive(60, 8)) test::step(slam, stage, false);
  const std::vector<double> weights = slam.weights();
  std::map<core::LandmarkId, std::vector<std::pair<double, core::MapLandmark>>> held;
  for (std::size_t i = 0; i < options.particles; ++i) {
    for (const core::MapLandmark& landmark : slam.map_of(i)) held[landmark.id].emplace_back(weights[i], landmark);
  }
  const std::vector<core::MixedLandmark> mixture = slam.mixture();
  ASSERT_EQ(mixture.size(), held.size());
  ASSERT_GT(mixture.size(), 10u);
  for (const core::MixedLandmark& mixed : mixture) {
    double share = 0.0, mature = 0.0;
    Eigen::Vector2d mean_m = Eigen::Vector2d::Zero();
    for (const auto& [w, landmark] : held.at(mixed.id)) {
      share += w;
      mature += landmark.state == core::LandmarkState::mature ? w : 0.0;
      mean_m += w * landmark.point.mean_m;
    }
    mean_m /= share;
    Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
    for (const auto& [w, landmark] : held.at(mixed.id)) {
      const Eigen::Vector2d d = landmark.point.mean_m - mean_m;
      covariance_m2 += w / share * (landmark.point.covariance_m2 + d * d.transpose());
    }
    EXPECT_NEAR(mixed.share, share, 1e-12);
    EXPECT_NEAR(mixed.mature_share, mature, 1e-12);
    EXPECT_LT((mixed.point.mean_m - mean_m).norm(), 1e-9);
    EXPECT_LT((mixed.point.covariance_m2 - covariance_m2).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace helixnav::fastslam
