// SPDX-License-Identifier: BSD-3-Clause
// Places that look alike from where the vehicle is, told apart by the shape of what was mapped before.
#include "closing/shape_evidence.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/core/rigid_fit.hpp"

namespace helixnav::supervisor {
namespace {

using Posts = std::vector<Eigen::Vector2d>;

constexpr double post_sigma_m = 0.05;    // of a landmark relative to those around it
constexpr double copies_sigma_m = 0.02;  // of what two copies of one differ by

/// Two rows of posts 5 m apart along a road that turns by `turn_rad` at each of these posts.
Posts road(const std::vector<double>& turn_rad) {
  Posts posts_m;
  core::Pose2 pose;
  for (const double turn : turn_rad) {
    pose = core::compose(pose, {5.0, 0.0, turn});
    for (const double side_m : {-2.0, 2.0}) posts_m.push_back(core::transform(pose, Eigen::Vector2d(0.0, side_m)));
  }
  return posts_m;
}

std::vector<double> straight(std::size_t posts) { return std::vector<double>(posts, 0.0); }

std::vector<double> with_bend(std::size_t posts) {
  std::vector<double> turns(posts, 0.0);
  for (std::size_t k = posts / 2; k < posts / 2 + 4 && k < posts; ++k) turns[k] = 0.25;
  return turns;
}

/// The old map has landmarks 0, 1, …; the branch has seen those from `from` on again, as landmarks after them, moved as a whole by an
/// error that is hardly known.
struct TwoPasses {
  std::size_t from;
  cekf::CompressedEkf filter;
  std::vector<core::LandmarkId> old;
  Branch branch;

  core::LandmarkId copy_of(std::size_t k) const { return static_cast<core::LandmarkId>(old.size() + k - from); }
  /// Of the last eight, as if they were `posts` rows further on.
  KeptRemoved last_ones(int posts) const {
    KeptRemoved pairs;
    for (std::size_t k = old.size() - 12; k < old.size() - 4; ++k) {
      pairs.emplace_back(static_cast<core::LandmarkId>(k) + 2 * posts, copy_of(k));
    }
    return pairs;
  }
};

TwoPasses driven_twice(const Posts& posts_m, std::size_t from) {
  core::RandomStream random(7, "two passes");
  core::JointGaussian joint;
  const std::size_t n = posts_m.size(), copies = n - 4 - from;
  const auto columns = static_cast<Eigen::Index>(3 + 2 * (n + copies));
  joint.covariance = post_sigma_m * post_sigma_m * Eigen::MatrixXd::Identity(columns, columns);
  const auto noisy = [&](const Eigen::Vector2d& at_m) {
    const double dx_m = random.normal(0.0, post_sigma_m), dy_m = random.normal(0.0, post_sigma_m);
    joint.ids.push_back(static_cast<core::LandmarkId>(joint.ids.size()));
    joint.points_m.push_back(at_m + Eigen::Vector2d(dx_m, dy_m));
  };
  TwoPasses passes{from, cekf::CompressedEkf(core::PoseGaussian{}), {}, {}};
  for (const Eigen::Vector2d& post_m : posts_m) noisy(post_m);
  passes.old = joint.ids;
  passes.branch.old_drive.field_of_view = {0.0, 15.0, -core::pi, core::pi};
  for (const Eigen::Vector2d& post_m : posts_m)
    passes.branch.old_drive.T_frame_sensor.emplace_back(post_m.x(), post_m.y(), 0.0);
  Eigen::MatrixXd moves = Eigen::MatrixXd::Zero(columns, 3);
  for (std::size_t k = from; k < n - 4; ++k) {
    const auto row = 3 + 2 * static_cast<Eigen::Index>(joint.ids.size());
    noisy(core::transform({1.0, -0.7, 0.03}, posts_m[k]));
    passes.branch.confirmed.push_back(joint.ids.back());
    const Eigen::Vector2d& at_m = joint.points_m.back();
    moves.block<2, 3>(row, 0) << 1.0, 0.0, -at_m.y(), 0.0, 1.0, at_m.x();
  }
  joint.covariance += moves * Eigen::Vector3d(9.0, 9.0, 0.01).asDiagonal() * moves.transpose();
  cekf::FilterOptions whole;
  whole.cell_side_m = 1e9;
  whole.max_active_landmarks = static_cast<int>(n + copies);
  passes.filter = cekf::CompressedEkf(joint, static_cast<core::LandmarkId>(joint.ids.size()), whole);
  return passes;
}

std::optional<core::ShapeDecision> decided_between(const TwoPasses& passes, const std::vector<int>& shifts) {
  std::vector<AlongBranch> places;
  for (const int posts : shifts) {
    places.push_back(continued_along(passes.filter, passes.branch, passes.old, passes.last_ones(posts), {}));
  }
  return decided_by_shape(passes.filter, places, {});
}

TEST(ShapeEvidence, IsWhatTheBestRigidFitLeaves) {
  const TwoPasses passes = driven_twice(road(with_bend(20)), 0);
  const KeptRemoved pairs = passes.last_ones(0);
  Posts kept_m, removed_m;
  for (const auto& [kept, removed] : pairs) {
    kept_m.push_back(passes.filter.landmark_mean(kept));
    removed_m.push_back(passes.filter.landmark_mean(removed));
  }
  const core::Pose2 T = core::fit_rigidly(kept_m, removed_m);
  double left = 0.0;
  for (std::size_t k = 0; k < kept_m.size(); ++k) left += (core::transform(T, removed_m[k]) - kept_m[k]).squaredNorm();
  const std::optional<ShapeCost> cost = shape_cost(passes.filter, pairs, copies_sigma_m);
  ASSERT_TRUE(cost);
  EXPECT_EQ(cost->dof, 13);
  EXPECT_NEAR(cost->chi2, left / (2.0 * post_sigma_m * post_sigma_m + copies_sigma_m * copies_sigma_m),
              1e-3 * cost->chi2);
}

TEST(ShapeEvidence, ContinuesThePairsBackToTheFirst) {
  const TwoPasses passes = driven_twice(road(with_bend(20)), 6);
  const AlongBranch along = continued_along(passes.filter, passes.branch, passes.old, passes.last_ones(0), {});
  EXPECT_EQ(along.pairs.size(), passes.branch.confirmed.size());
  for (const auto& [kept, removed] : along.pairs) EXPECT_EQ(passes.copy_of(static_cast<std::size_t>(kept)), removed);
}

TEST(ShapeEvidence, ASharpBendTellsWhichPostsTheyAre) {
  const TwoPasses passes = driven_twice(road(with_bend(20)), 4);
  const std::optional<core::ShapeDecision> decided = decided_between(passes, {1, 0, -1});
  ASSERT_TRUE(decided);
  EXPECT_EQ(decided->place, 1);
  EXPECT_EQ(decided->places, 3);
  EXPECT_EQ(decided->pairs, static_cast<int>(passes.branch.confirmed.size()));
  EXPECT_LT(decided->chi2, 2.0 * decided->dof);
  EXPECT_LE(decided->rival_pairs, decided->pairs);
  EXPECT_TRUE(decided->rival_chi2 > 2.0 * decided->rival_dof || decided->rival_alone > decided->alone);
}

TEST(ShapeEvidence, AGentleBendTellsWhichPostsTheyAre) {
  std::vector<double> turns(20, 0.0);
  for (std::size_t k = 8; k < 13; ++k) turns[k] = 0.06;
  const TwoPasses passes = driven_twice(road(turns), 4);
  const std::optional<core::ShapeDecision> decided = decided_between(passes, {1, 0, -1});
  ASSERT_TRUE(decided);
  EXPECT_EQ(decided->place, 1);
}

TEST(ShapeEvidence, AStraightRoadTellsNothing) {
  EXPECT_FALSE(decided_between(driven_twice(road(straight(20)), 4), {1, 0, -1}));
}

TEST(ShapeEvidence, ACircleTellsNothing) {
  EXPECT_FALSE(decided_between(driven_twice(road(std::vector<double>(20, 0.1)), 4), {1, 0, -1}));
}

TEST(ShapeEvidence, APlaceThatExplainsLessIsNotDecidedFor) {
  const TwoPasses passes = driven_twice(road(with_bend(20)), 4);
  AlongBranch all = continued_along(passes.filter, passes.branch, passes.old, passes.last_ones(0), {});
  all.pairs[3].first = all.pairs[20].first - 4;  // wrong, so that its shape does not fit
  AlongBranch few{passes.last_ones(0), 0};
  EXPECT_FALSE(decided_by_shape(passes.filter, {all, few}, {}));
}

}  // namespace
}  // namespace helixnav::supervisor
