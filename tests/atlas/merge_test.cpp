// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "atlas_access.hpp"
#include "helixnav/core/errors.hpp"
#include "small_drive.hpp"

namespace helixnav::atlas {
namespace {

/// The same drive, with its second half giving other names to what it sees.
struct Doubled {
  testing::SmallDrive drive;
  std::vector<MergePair> pairs;
};

Doubled doubled_drive(std::uint64_t seed) {
  Doubled doubled{testing::make_small_drive(seed), {}};
  auto& logs = doubled.drive.logs;
  for (std::size_t k = logs.size() / 2; k < logs.size(); ++k) {
    auto renamed = std::make_shared<PhaseLog>(*logs[k]);
    for (LoggedStep& step : renamed->steps) {
      for (SeenLandmark& seen : step.seen) seen.id += 100;
    }
    logs[k] = renamed;
  }
  for (core::LandmarkId id = 5; id < 20; id += 4) doubled.pairs.emplace_back(id + 100, id);
  return doubled;
}

/// The problem of the drive with the second half's landmarks separate, except for the pairs.
smoothing::Problem problem_of(const Doubled& doubled, bool merged) {
  smoothing::Problem problem = doubled.drive.problem;
  const int half = static_cast<int>(problem.graph.poses.size()) / 2;
  std::map<int, int> other;
  for (auto& edge : problem.graph.landmark_edges) {
    if (edge.pose <= half) continue;
    const auto name =
        static_cast<core::LandmarkId>(problem.graph.landmarks[static_cast<std::size_t>(edge.landmark)].name);
    const bool same = merged && std::find(doubled.pairs.begin(), doubled.pairs.end(), MergePair(name + 100, name)) !=
                                    doubled.pairs.end();
    if (same) continue;
    const auto [place, is_new] = other.try_emplace(edge.landmark, static_cast<int>(problem.graph.landmarks.size()));
    if (is_new)
      problem.graph.landmarks.push_back(
          {name + 100, problem.graph.landmarks[static_cast<std::size_t>(edge.landmark)].point_m});
    edge.landmark = place->second;
  }
  return problem;
}

TEST(Merge, CostsTheDifferenceOfTheBatchOptima) {
  const Doubled doubled = doubled_drive(16);
  Atlas atlas = testing::driven(doubled.drive);
  smoothing::Problem apart = problem_of(doubled, false);
  smoothing::Problem as_one = problem_of(doubled, true);
  const double chi2_apart = testing::solve(apart);
  const double chi2_as_one = testing::solve(as_one);
  EXPECT_NEAR(atlas.chi2(), chi2_apart, 1e-6);
  const Atlas before = atlas;
  const MergeCost cost = atlas.merge_cost(doubled.pairs);
  EXPECT_NEAR(cost.chi2, chi2_as_one - chi2_apart, 1e-6);
  EXPECT_EQ(cost.dof, 8);
  EXPECT_TRUE(testing::same_bytes(AtlasAccess::settled(atlas), AtlasAccess::settled(before)));
  atlas.merge(doubled.pairs);
  atlas.settle();
  EXPECT_NEAR(atlas.chi2(), chi2_as_one, 1e-6);
  for (const auto& landmark : as_one.graph.landmarks) {
    const auto id = static_cast<core::LandmarkId>(landmark.name);
    if (!atlas.knows(id)) continue;
    EXPECT_LT((atlas.landmark(id) - landmark.point_m).norm(), 1e-6) << id;
  }
  EXPECT_EQ(atlas.landmark(105), atlas.landmark(5));  // both names refer to it
  for (const Place& place : atlas.landmarks()) EXPECT_NE(place.id, 105);
}

TEST(Merge, WithADefaultBendIsCloseToTheBatchDifference) {
  const Doubled doubled = doubled_drive(17);
  const Atlas atlas = testing::driven(doubled.drive, Options());
  smoothing::Problem apart = problem_of(doubled, false);
  smoothing::Problem as_one = problem_of(doubled, true);
  const double difference = testing::solve(as_one) - testing::solve(apart);
  EXPECT_NEAR(atlas.merge_cost(doubled.pairs).chi2, difference, 0.1);
}

TEST(Merge, OfALandmarkWithItselfOrWithNobodyIsRefused) {
  Atlas atlas = testing::driven(testing::make_small_drive(18), Options());
  EXPECT_THROW(atlas.merge({{3, 3}}), core::PreconditionError);
  EXPECT_THROW(atlas.merge({{3, 300}}), core::PreconditionError);
  EXPECT_TRUE(atlas.is_settled());
}

TEST(Forget, TakesTheNameAndNothingElse) {
  Atlas atlas = testing::driven(testing::make_small_drive(19), Options());
  const core::JointGaussian before = atlas.joint({4, 6});
  atlas.forget(5);
  EXPECT_FALSE(atlas.knows(5));
  EXPECT_THROW(atlas.landmark(5), core::PreconditionError);
  EXPECT_TRUE(testing::same_bytes(atlas.joint({4, 6}).covariance, before.covariance));
}

}  // namespace
}  // namespace helixnav::atlas
