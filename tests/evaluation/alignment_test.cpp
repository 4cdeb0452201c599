// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/evaluation/alignment.hpp"

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::evaluation {
namespace {

using Points = std::vector<Eigen::Vector2d>;

const core::Pose2 T_a_b(-71.0, 43.5, 2.9);

struct Pairs {
  Points a;
  Points b;
  int outliers = 0;
};

Pairs make_pairs(double outlier_fraction, double sigma_m, std::uint64_t seed) {
  core::RandomStream random(seed, "pairs");
  Pairs pairs;
  for (int i = 0; i < 500; ++i) {
    pairs.b.emplace_back(random.uniform(-100.0, 100.0), random.uniform(-60.0, 60.0));
    Eigen::Vector2d a = core::transform(T_a_b, pairs.b.back());
    a += sigma_m * Eigen::Vector2d(random.normal(), random.normal());
    if (random.bernoulli(outlier_fraction)) {
      a += Eigen::Vector2d(150.0 + 50.0 * random.uniform(), 100.0 * random.uniform());  // all to one side
      ++pairs.outliers;
    }
    pairs.a.push_back(a);
  }
  return pairs;
}

TEST(Alignment, RecoversAKnownMotionExactlyWithoutNoise) {
  const Pairs pairs = make_pairs(0.0, 0.0, 1);
  const RigidAlignment found = align_rigidly(pairs.a, pairs.b, 10.0);
  EXPECT_NEAR(found.T_a_b.x_m, T_a_b.x_m, 1e-10);
  EXPECT_NEAR(found.T_a_b.y_m, T_a_b.y_m, 1e-10);
  EXPECT_NEAR(found.T_a_b.heading_rad, T_a_b.heading_rad, 1e-12);
  EXPECT_EQ(found.used_count, 500);
}

class AlignmentWithOutliers : public ::testing::TestWithParam<double> {};

TEST_P(AlignmentWithOutliers, LeavesThemOutAndRecoversTheMotion) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Pairs pairs = make_pairs(GetParam(), 0.5, seed);
    const RigidAlignment found = align_rigidly(pairs.a, pairs.b, 10.0);
    EXPECT_EQ(found.used_count, 500 - pairs.outliers);
    // Five standard deviations of the fit over ≥ 280 pairs: 0.5 m/√280 and 0.5 m/(67 m·√280).
    EXPECT_NEAR(found.T_a_b.x_m, T_a_b.x_m, 0.15);
    EXPECT_NEAR(found.T_a_b.y_m, T_a_b.y_m, 0.15);
    EXPECT_NEAR(found.T_a_b.heading_rad, T_a_b.heading_rad, 0.0025);
  }
}

INSTANTIATE_TEST_SUITE_P(Fractions, AlignmentWithOutliers, ::testing::Values(0.1, 0.4));

TEST(Alignment, CountsOnlyPairsWithinTheLimit) {
  const Points b = {{0, 0}, {100, 0}, {0, 100}, {100, 100}, {50, 50}};
  Points a = b;
  a[4] += Eigen::Vector2d(0.0, 20.0);  // 16 m off the fit of all five
  const RigidAlignment found = align_rigidly(a, b, 10.0);
  EXPECT_EQ(found.used, (std::vector<bool>{true, true, true, true, false}));
  EXPECT_NEAR(found.T_a_b.y_m, 0.0, 1e-12);
}

TEST(Alignment, OfOnePointIsATranslationAndOfNoneTheIdentity) {
  const RigidAlignment one = align_rigidly({{3.0, 4.0}}, {{1.0, 1.0}}, 10.0);
  EXPECT_EQ(one.T_a_b.vector(), Eigen::Vector3d(2.0, 3.0, 0.0));
  EXPECT_EQ(align_rigidly({}, {}, 10.0).used_count, 0);
  EXPECT_THROW(align_rigidly({{1.0, 2.0}}, {}, 10.0), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::evaluation
