// SPDX-License-Identifier: BSD-3-Clause
// Merging as many pairs as the maps of two sessions share, with H treated as sparse: equal to the full filter.
#include <gtest/gtest.h>

#include "full_ekf.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::cekf {
namespace {

constexpr int wide_pairs = 130;  // 3 + 4·130 columns of H
constexpr double wide_sigma_m = 0.02;

/// Landmarks 2·k and 2·k + 1 are the same one; all errors are correlated.
core::JointGaussian doubled_landmarks() {
  core::RandomStream random(3, "doubled");
  core::JointGaussian joint;
  const Eigen::Index n = 3 + 4 * wide_pairs;
  Eigen::MatrixXd root(n, 40);
  for (Eigen::Index i = 0; i < root.size(); ++i) root(i) = random.normal(0.0, 0.05);
  root.row(2) *= 0.2;
  joint.covariance = root * root.transpose() + 1e-3 * Eigen::MatrixXd::Identity(n, n);
  joint.pose = core::Pose2(3.0, -2.0, 0.4);
  for (int k = 0; k < wide_pairs; ++k) {
    const double x_m = random.uniform(-60.0, 60.0);
    const Eigen::Vector2d at_m(x_m, random.uniform(-60.0, 60.0));
    for (int copy = 0; copy < 2; ++copy) {
      const double dx_m = random.normal(0.0, 0.1);
      joint.ids.push_back(2 * k + copy);
      joint.points_m.emplace_back(at_m + Eigen::Vector2d(dx_m, random.normal(0.0, 0.1)));
    }
  }
  return joint;
}

support::FullEkf full_at(const core::JointGaussian& joint, Retraction retraction) {
  support::FullEkf ekf({joint.pose, Eigen::Matrix3d::Identity()}, retraction == Retraction::right_invariant);
  ekf.x.resize(joint.covariance.rows());
  ekf.x.head<3>() = joint.pose.vector();
  for (std::size_t i = 0; i < joint.ids.size(); ++i) {
    ekf.x.segment<2>(3 + 2 * static_cast<Eigen::Index>(i)) = joint.points_m[i];
  }
  ekf.P = joint.covariance;
  ekf.ids = joint.ids;
  return ekf;
}

class WideMerge : public testing::TestWithParam<Retraction> {};

TEST_P(WideMerge, EqualsTheFullFilterWithAllLandmarksActiveOrFew) {
  const core::JointGaussian joint = doubled_landmarks();
  std::vector<CompressedEkf::LandmarkPair> pairs;
  for (int k = 0; k < wide_pairs; ++k) pairs.emplace_back(2 * k, 2 * k + 1);
  support::FullEkf oracle = full_at(joint, GetParam());
  const double cost = oracle.merge(pairs, wide_sigma_m);
  for (const double cell_side_m : {1e9, 20.0}) {
    FilterOptions options;
    options.retraction = GetParam();
    options.cell_side_m = cell_side_m;
    options.max_active_landmarks = cell_side_m > 100.0 ? 2 * wide_pairs : 120;
    CompressedEkf filter(joint, 2 * wide_pairs, options);
    EXPECT_NEAR(filter.merge_cost(pairs, wide_sigma_m).cost, cost, 1e-6 * cost);
    EXPECT_NEAR(filter.merge(pairs, wide_sigma_m).nis, cost, 1e-6 * cost);
    const core::JointGaussian merged = filter.joint(oracle.ids);
    EXPECT_LE((merged.covariance - oracle.P).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LE((merged.pose.vector() - oracle.x.head<3>()).cwiseAbs().maxCoeff(), 1e-9);
    for (std::size_t i = 0; i < oracle.ids.size(); ++i) {
      const Eigen::Vector2d expected_m = oracle.x.segment<2>(3 + 2 * static_cast<Eigen::Index>(i));
      EXPECT_LE((merged.points_m[i] - expected_m).norm(), 1e-8) << oracle.ids[i];
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Both, WideMerge, testing::Values(Retraction::standard, Retraction::right_invariant));

}  // namespace
}  // namespace helixnav::cekf
