// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "enumeration.hpp"
#include "helixnav/association/associate.hpp"
#include "helixnav/association/joint_innovation.hpp"
#include "scenes.hpp"

namespace helixnav::association {
namespace {

struct Best {
  std::size_t pairs = 0;
  double nis = std::numeric_limits<double>::infinity();
};

/// Joint NIS of every set of pairs by a dense Cholesky factor of its own joint covariance.
Best brute_force(const InnovationProblem& problem, double joint_probability) {
  std::vector<int> all(problem.pairs.size());
  for (std::size_t p = 0; p < all.size(); ++p) all[p] = static_cast<int>(p);
  const JointInnovation joint = joint_innovation(problem, all);
  double threshold[16] = {};
  for (int dof = 1; dof < 16; ++dof) threshold[dof] = core::chi2_quantile(joint_probability, dof);
  Best best;
  for_each_assignment(likelihood_ratio_costs(problem, 0.5, {}), [&](const std::vector<int>& entry) {
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 12, 12> S;
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 12, 1> nu;
    int rows[6];
    int n = 0;
    int dof = 0;
    for (const int p : entry) {
      if (p < 0) continue;
      rows[n++] = p;
      dof += problem.pairs[p].dof;
    }
    if (n == 0 || static_cast<std::size_t>(n) < best.pairs) return;
    S.resize(2 * n, 2 * n);
    nu.resize(2 * n);
    for (int a = 0; a < n; ++a) {
      nu.segment<2>(2 * a) = joint.nu.segment<2>(2 * rows[a]);
      for (int b = 0; b < n; ++b) S.block<2, 2>(2 * a, 2 * b) = joint.S.block<2, 2>(2 * rows[a], 2 * rows[b]);
    }
    const double nis = nu.dot(S.llt().solve(nu));
    if (nis > threshold[dof]) return;
    if (static_cast<std::size_t>(n) > best.pairs || nis < best.nis) best = {static_cast<std::size_t>(n), nis};
  });
  return best;
}

TEST(Jcbb, EqualsBruteForceOnTenThousandScansOfMixedKinds) {
  core::RandomStream random(12, "jcbb");
  Options options;
  options.joint_probability = 0.95;  // often refuses the largest set
  int refused = 0;
  for (int t = 0; t < 10'000; ++t) {
    const Scene scene = crowded_scene(random, static_cast<int>(random.below(7)), static_cast<int>(random.below(7)), 0.2,
                                      6.0, t % 2 == 1);
    const InnovationProblem problem = make_innovation_problem(scene.map, scene.scan);
    const Assignment found = associate(Method::jcbb, problem, options);
    const Best best = brute_force(problem, options.joint_probability);
    ASSERT_EQ(found.pairs.size(), best.pairs);
    ASSERT_NEAR(found.joint_nis, best.pairs > 0 ? best.nis : 0.0, 1e-7 * (1.0 + found.joint_nis));
    ASSERT_FALSE(found.budget_hit);
    ASSERT_EQ(found.dropped_pairs, 0);
    std::size_t possible = 0;
    for (const GatedObservation& o : problem.observations) possible += o.begin < o.end;
    refused += best.pairs < possible;
  }
  EXPECT_GT(refused, 1000);
}

TEST(Jcbb, SaysWhenItsBudgetEndedAndKeepsTheBestSoFar) {
  core::RandomStream random(13, "budget");
  const Scene scene = crowded_scene(random, 40, 40, 0.3, 2.0);
  const InnovationProblem problem = make_innovation_problem(scene.map, scene.scan);
  Options options;
  for (const std::int64_t budget : {1, 10, 1000}) {
    options.node_budget = budget;
    const Assignment found = associate(Method::jcbb, problem, options);
    EXPECT_TRUE(found.budget_hit);
    EXPECT_EQ(found.nodes, budget);
    EXPECT_EQ(found.observations.size(), 40u);
  }
}

TEST(Jcbb, SeparatesTwinsThatOnlyTheSharedPoseTellsApart) {
  // Two landmarks 1 m apart, robot uncertain by 1 m along the same line: each observation alone is nearer to the wrong
  // landmark, together only the right pairing leaves both residuals equal.
  core::JointGaussian map;
  map.ids = {0, 1, 2};
  map.points_m = {{10.0, 0.0}, {11.0, 0.0}, {10.5, 6.0}};
  map.covariance = Eigen::MatrixXd::Identity(9, 9) * 1e-6;
  map.covariance(0, 0) = 1.0;
  core::Scan scan;
  const Eigen::Matrix2d R = Eigen::Matrix2d::Identity() * 1e-3;
  for (const Eigen::Vector2d& m : map.points_m) {
    scan.observations.push_back(core::make_cartesian(m + Eigen::Vector2d(0.6, 0.0), R));
  }
  const InnovationProblem problem = make_innovation_problem(map, scan);
  EXPECT_EQ(associate(Method::nearest_neighbour, problem, {}).observations[0].landmark, 1);
  const Assignment joint = associate(Method::jcbb, problem);
  ASSERT_EQ(joint.pairs.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(joint.observations[i].landmark, i);
}

}  // namespace
}  // namespace helixnav::association
