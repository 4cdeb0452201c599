// SPDX-License-Identifier: BSD-3-Clause
#include "search/old_ground.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "helixnav/pf_relocalize/bases.hpp"
#include "search/constellation_question.hpp"

namespace helixnav::supervisor {
namespace {

using Ids = std::vector<core::LandmarkId>;

constexpr double range_m = 20.0;

core::Odometry motion(double ahead_m, double sigma_m, double sigma_rad) {
  core::Odometry odometry;
  odometry.T_before_after = core::Pose2(ahead_m, 0.0, 0.0);
  odometry.covariance.diagonal() << sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad;
  return odometry;
}

/// A row of n trees 4 m apart, from 5 m ahead of the vehicle on.
Ids map_row(cekf::CompressedEkf& filter, int n) {
  Ids ids;
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector2d ahead_m(5.0 + 4.0 * i, 3.0);
    ids.push_back(filter.augment(core::make_cartesian(ahead_m, 1e-4 * Eigen::Matrix2d::Identity()), {}));
  }
  return ids;
}

/// Some trees of old ground, a long drive round to 80 m before it, other trees, and 60 m further among them.
struct ReturnAmongTrees {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  Ids old, passed;

  ReturnAmongTrees(int old_trees, int passed_trees) {
    old = map_row(filter, old_trees);
    filter.predict(motion(-80.0, 5.0, 0.04));
    passed = map_row(filter, passed_trees);
    filter.predict(motion(60.0, 0.5, 0.01));
  }

  core::JointGaussian joint() const {
    Ids all = old;
    all.insert(all.end(), passed.begin(), passed.end());
    return filter.joint(all);
  }
};

TEST(OldGround, LeavesOutWhatTheVehicleHasJustPassed) {
  for (const int passed : {1, 4, 8}) {
    const ReturnAmongTrees back(8, passed);
    EXPECT_EQ(old_ground(back.joint(), range_m).ids, back.old) << passed << " passed";
  }
}

TEST(OldGround, KeepsTheJointEstimateOfWhatItKeeps) {
  const ReturnAmongTrees back(6, 3);
  const core::JointGaussian ground = old_ground(back.joint(), range_m);
  const core::JointGaussian alone = back.filter.joint(back.old);
  EXPECT_EQ(ground.points_m, alone.points_m);
  EXPECT_LE((ground.covariance - alone.covariance).norm(), 1e-12 * alone.covariance.norm());
}

TEST(OldGround, IsAllOfIt) {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  const Ids old = map_row(filter, 20);
  filter.predict(motion(-30.0, 2.0, 0.05));
  EXPECT_EQ(old_ground(filter.joint(old), range_m).ids, old);
  EXPECT_EQ(old_ground(filter.joint(old), 0.1).ids, old) << "none in view";
}

TEST(OldGround, GivesAFrameInWhichTheReturnIsAsUncertainAsItIs) {
  const ReturnAmongTrees back(4, 8);
  const auto heading_sigma = [](const core::JointGaussian& joint) {
    return std::sqrt(pf_relocalize::in_base_frame(joint, pf_relocalize::choose_bases(joint)).covariance(2, 2));
  };
  EXPECT_GT(heading_sigma(back.joint()), 0.07) << "one base here and one there";
  EXPECT_NEAR(heading_sigma(old_ground(back.joint(), range_m)), std::hypot(0.04, 0.01), 0.005);
}

/// Ten trees mapped, then a drive of 30 m that may have drifted.
std::size_t still_compared(double sigma_m) {
  cekf::CompressedEkf filter{core::PoseGaussian{}};
  const Ids trees = map_row(filter, 10);
  association::LandmarkLife life;
  life.observe({0.0, 0.0}, {}, trees, {});
  life.drive(30.0);
  filter.predict(motion(30.0, sigma_m, 1e-4));
  return branch_landmarks({filter, life, CoverageTrace(4.0), core::Scan{}}, {}, {}).size();
}

TEST(BranchLandmarks, AreThoseThatTheVehicleHasNotDriftedOffFrom) {
  EXPECT_EQ(still_compared(0.1), 10u);
  EXPECT_EQ(still_compared(0.45), 10u);
  EXPECT_EQ(still_compared(0.55), 0u) << "3 sigma are more than any pair is granted";
}

}  // namespace
}  // namespace helixnav::supervisor
