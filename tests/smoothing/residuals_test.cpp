// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/smoothing/residuals.hpp"

#include <gtest/gtest.h>

#include "helixnav/smoothing/optimize.hpp"
#include "random_problem.hpp"

namespace helixnav::smoothing {
namespace {

TEST(LargestResiduals, PutAWrongObservationFirstAndNameIt) {
  Problem problem = testing::random_problem(1).problem;
  auto& edge = problem.graph.landmark_edges[40];
  edge.observation.z[0] += 1.5;
  optimize(problem);
  const std::vector<Residual> worst = largest_residuals(problem, 3);
  ASSERT_EQ(worst.size(), 3u);
  EXPECT_EQ(worst[0].edge, 40);
  EXPECT_EQ(worst[0].name, pose_name(problem, edge.pose) + " sees " + landmark_name(problem, edge.landmark));
  EXPECT_GE(worst[0].nis / static_cast<double>(worst[0].e.size()),
            worst[1].nis / static_cast<double>(worst[1].e.size()));
}

TEST(LargestResiduals, AddUpToChi2) {
  Problem problem = testing::random_problem(2).problem;
  core::AbsoluteFix fix;
  fix.position_world_m = {2.0, 2.0};
  problem.graph.fix_edges.push_back({4, fix});
  double sum = 0.0;
  for (const Residual& residual : largest_residuals(problem, 100000)) sum += residual.nis;
  const double chi2 = evaluate_chi2(problem).total();
  EXPECT_NEAR(sum, chi2, 1e-9 * chi2);
}

}  // namespace
}  // namespace helixnav::smoothing
