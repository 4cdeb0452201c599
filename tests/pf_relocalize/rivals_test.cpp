// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/rivals.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"
#include "lattice_world.hpp"

namespace helixnav::pf_relocalize {
namespace {

bool has_pose_near(const std::vector<core::Pose2>& poses, const core::Pose2& pose) {
  return std::any_of(poses.begin(), poses.end(), [&](const core::Pose2& p) {
    return (p.position_m() - pose.position_m()).norm() < 0.5 &&
           std::abs(core::wrap_to_pi(p.heading_rad - pose.heading_rad)) < 0.05;
  });
}

TEST(Rivals, FindsEveryShiftOfALatticeInsideThePrior) {
  for (const double pitch : {4.0, 5.0, 7.0}) {
    test::Lattice lattice;
    lattice.pitch_m = pitch;
    lattice.entered_m = 60.0;
    lattice.now_m = 80.0;
    const ReferenceMap map = lattice.map(4.0, 2.0, 0.06);
    const RivalPoses poses = find_rivals(map, lattice.constellation().branch, lattice.truth(), {}, 1);
    for (int k = -2; k <= 2; ++k) {
      if (k == 0) continue;
      EXPECT_TRUE(has_pose_near(poses.rivals, {80.0 + k * pitch, 0.0, 0.0})) << pitch << " " << k;
    }
    EXPECT_LE(poses.rivals.size(), 25U);
  }
}

TEST(Rivals, AreInsideThePriorAwayFromTheWinnerAndFromOneAnother) {
  test::Lattice lattice;
  const ReferenceMap map = lattice.map(5.0, 3.0, 0.1);
  const RivalOptions options;
  const RivalPoses poses = find_rivals(map, lattice.constellation().branch, lattice.truth(), options, 2);
  for (std::size_t i = 0; i < poses.rivals.size(); ++i) {
    const core::Pose2& p = poses.rivals[i];
    const Eigen::Vector3d d = p.vector() - map.prior.mean.vector();
    EXPECT_LE(d.cwiseQuotient(map.prior.covariance.diagonal().cwiseSqrt()).squaredNorm(), options.prior_chi2 + 1e-6);
    EXPECT_TRUE((p.position_m() - poses.winner.position_m()).norm() > options.apart_m ||
                std::abs(p.heading_rad - poses.winner.heading_rad) > options.apart_rad);
  }
}

TEST(Rivals, RefineTheWinnerOntoTheMap) {
  test::Lattice lattice;
  core::RandomStream random(3, "rivals");
  for (int run = 0; run < 20; ++run) {
    const core::Pose2 off =
        core::compose(lattice.truth(), {random.normal(0.0, 0.3), random.normal(0.0, 0.3), random.normal(0.0, 0.01)});
    const RivalPoses poses =
        find_rivals(lattice.map(5.0, 3.0, 0.1), lattice.constellation().branch, off, {100, 5, 5}, 1);
    EXPECT_LT(core::between(lattice.truth(), poses.winner).vector().norm(), 0.05);
  }
}

TEST(Rivals, WithConstellationTestRefuseLatticesAndAcceptScatteredTrees) {
  core::RandomStream random(4, "scatter");
  int accepted = 0;
  for (int run = 0; run < 10; ++run) {
    test::Lattice lattice;
    lattice.entered_m = 60.0;
    lattice.now_m = 80.0;
    Constellation c = lattice.constellation();
    ReferenceMap map = lattice.map(4.0, 2.0, 0.06);
    const RivalPoses shifted = find_rivals(map, c.branch, lattice.truth(), {}, 5);
    EXPECT_FALSE(judge_constellation(c, shifted.winner, shifted.rivals).accepted);
    for (std::size_t i = 0; i < c.old_landmarks.size(); ++i) {  // the same drive among randomly placed trees
      const Eigen::Vector2d move(random.uniform(-2.5, 2.5), random.uniform(-3.0, 3.0));
      c.old_landmarks[i].point.mean_m += move;
      map.landmarks[i].mean_m += move;
      for (BranchLandmark& b : c.branch)
        b.point_robot_m += b.id - 1000 == c.old_landmarks[i].id ? move : Eigen::Vector2d(0, 0);
    }
    const RivalPoses scattered = find_rivals(map, c.branch, lattice.truth(), {}, 5);
    accepted += judge_constellation(c, scattered.winner, scattered.rivals).accepted ? 1 : 0;
  }
  EXPECT_GE(accepted, 9);
}

TEST(Rivals, NeedThreeBranchLandmarks) {
  test::Lattice lattice;
  std::vector<BranchLandmark> branch = lattice.constellation().branch;
  branch.resize(2);
  EXPECT_TRUE(find_rivals(lattice.map(4.0, 2.0, 0.06), branch, lattice.truth(), {}, 1).rivals.empty());
}

}  // namespace
}  // namespace helixnav::pf_relocalize
