// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/merge_candidates.hpp"

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"

namespace helixnav::association {
namespace {

/// Landmarks 0, 1 mapped on the way out, 2, 3 on the way back; both pairs half a metre apart in the same direction.
class MergeCandidates : public ::testing::Test {
 protected:
  MergeCandidates() {
    map.ids = {0, 1, 2, 3};
    map.points_m = {{10.0, 0.0}, {10.0, 5.0}, {10.5, 0.0}, {10.5, 5.0}};
    map.covariance = Eigen::MatrixXd::Identity(11, 11) * 0.01;
    // Drift: common to what was mapped on one way.
    for (int a = 0; a < 2; ++a) {
      for (int b = 0; b < 2; ++b) map.covariance.block<2, 2>(7 + 2 * a, 7 + 2 * b).diagonal().array() += 0.25;
    }
    const auto mature = [&](int a, int b) {
      life.observe({0.0, 0.0}, {}, {a, b}, {});
      for (int k = 1; k < 5; ++k) life.observe({1.0 * k, 0.0}, {a, b}, {}, {});
    };
    mature(0, 1);
    mature(2, 3);
  }
  core::JointGaussian map;
  LandmarkLife life;
};

TEST_F(MergeCandidates, AreFoundAndTestedTogether) {
  const std::vector<MergeCandidate> found = merge_candidates(map, life);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].kept, 0);
  EXPECT_EQ(found[0].merged, 2);
  EXPECT_EQ(found[1].kept, 1);
  EXPECT_EQ(found[1].merged, 3);
  EXPECT_NEAR(found[0].nis, 0.25 / 0.27, 1e-9);
  EXPECT_EQ(found[1].joint_dof, 4);
  EXPECT_NEAR(found[1].joint_nis, 2 * 0.25 / 0.52, 1e-9);  // the same shift twice costs hardly more than once
}

TEST_F(MergeCandidates, ThatFitAloneButNotTogetherAreNotReportedTogether) {
  map.points_m[3] = {9.2, 5.0};  // would need a shift of the other sign
  const std::vector<MergeCandidate> found = merge_candidates(map, life);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].merged, 2);
}

TEST_F(MergeCandidates, NeverStoodInOneScan) {
  life.observe({9.0, 0.0}, {0, 2}, {}, {});
  const std::vector<MergeCandidate> found = merge_candidates(map, life);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].merged, 3);
}

TEST_F(MergeCandidates, AreMature) { EXPECT_TRUE(merge_candidates(map, LandmarkLife{}).empty()); }

TEST_F(MergeCandidates, NeedACovarianceThatIsOne) {
  map.covariance = -map.covariance;
  EXPECT_THROW(merge_candidates(map, life), core::NumericalError);
}

}  // namespace
}  // namespace helixnav::association
