// SPDX-License-Identifier: BSD-3-Clause
#include "closing/contradicting_pairs.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "helixnav/core/chi2.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::supervisor {
namespace {

/// Landmarks 2·k and 2·k + 1 are the same one, all errors correlated; every `wrong`-th pair is 1 m apart.
cekf::CompressedEkf doubled_map(int pairs, int wrong, KeptRemoved& same) {
  core::RandomStream random(5, "doubled map");
  const Eigen::Index n = 3 + 4 * pairs;
  Eigen::MatrixXd root(n, n);
  for (Eigen::Index i = 0; i < root.size(); ++i) root(i) = random.normal(0.0, 0.005);
  core::JointGaussian joint;
  joint.covariance = root * root.transpose() + 1e-3 * Eigen::MatrixXd::Identity(n, n);
  for (int k = 0; k < pairs; ++k) {
    const double x_m = random.uniform(0.0, 300.0), y_m = random.uniform(0.0, 300.0);
    for (int copy = 0; copy < 2; ++copy) {
      const double dx_m = random.normal(0.0, 0.05), dy_m = random.normal(0.0, 0.05);
      const double off_m = copy == 1 && wrong > 0 && k % wrong == wrong - 1 ? 1.0 : 0.0;
      joint.ids.push_back(2 * k + copy);
      joint.points_m.emplace_back(x_m + dx_m + off_m, y_m + dy_m);
    }
    same.emplace_back(2 * k, 2 * k + 1);
  }
  cekf::FilterOptions whole;
  whole.cell_side_m = 1e9;
  whole.max_active_landmarks = 2 * pairs;
  return cekf::CompressedEkf(joint, 2 * pairs, whole);
}

constexpr double merged_sigma_m = 0.02;
constexpr double agreeing = 0.99;

TEST(ContradictingPairs, AreThoseThatSolvingAnewAfterEachDrops) {
  KeptRemoved pairs;
  const cekf::CompressedEkf filter = doubled_map(40, 7, pairs);
  const std::vector<std::size_t> left_out = contradicting_pairs(filter, pairs, merged_sigma_m, agreeing, {20, 0});
  std::vector<std::size_t> expected, places(pairs.size());
  for (std::size_t k = 0; k < places.size(); ++k) places[k] = k;
  KeptRemoved left = pairs;
  while (true) {
    const cekf::CostByPart cost = filter.merge_cost(left, merged_sigma_m);
    if (cost.cost <= core::chi2_quantile(agreeing, cost.dof)) break;
    const auto worst = std::max_element(cost.parts.begin(), cost.parts.end()) - cost.parts.begin();
    expected.push_back(places[static_cast<std::size_t>(worst)]);
    places.erase(places.begin() + worst);
    left.erase(left.begin() + worst);
  }
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(left_out, expected);
  EXPECT_GE(left_out.size(), 4u) << "of five that are 1 m off";
}

TEST(ContradictingPairs, AreNoneWhereAllAgreeAndNeverMoreThanAllowed) {
  KeptRemoved pairs;
  const cekf::CompressedEkf right = doubled_map(40, 0, pairs);
  EXPECT_TRUE(contradicting_pairs(right, pairs, merged_sigma_m, agreeing, {20, 0}).empty());
  KeptRemoved all_wrong;
  const cekf::CompressedEkf wrong = doubled_map(40, 2, all_wrong);
  EXPECT_EQ(contradicting_pairs(wrong, all_wrong, merged_sigma_m, agreeing, {3, 0}).size(), 3u);
}

TEST(ContradictingPairs, BeyondAnyAreOutliersAlone) {
  KeptRemoved pairs;
  const cekf::CompressedEkf filter = doubled_map(40, 7, pairs);
  std::vector<std::size_t> off;
  for (std::size_t k = 6; k < pairs.size(); k += 7) off.push_back(k);
  EXPECT_EQ(contradicting_pairs(filter, pairs, merged_sigma_m, 1e-6, {0, 20}), off);
  EXPECT_EQ(contradicting_pairs(filter, pairs, merged_sigma_m, 1e-6, {0, 2}).size(), 2u);
}

}  // namespace
}  // namespace helixnav::supervisor
