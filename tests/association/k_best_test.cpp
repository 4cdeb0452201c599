// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/k_best.hpp"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "enumeration.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::association {
namespace {

TEST(KBest, EqualsTheFirstOfAllAssignmentsSortedOnTenThousandProblems) {
  core::RandomStream random(4, "k best");
  for (int t = 0; t < 10'000; ++t) {
    const AssignmentProblem problem = random_assignment_problem(random);
    const int k = 1 + static_cast<int>(random.below(12));
    std::vector<double> costs;
    for_each_assignment(problem, [&](const std::vector<int>& e) { costs.push_back(cost_of(problem, e)); });
    const std::size_t expected = std::min<std::size_t>(k, costs.size());
    std::partial_sort(costs.begin(), costs.begin() + static_cast<std::ptrdiff_t>(expected), costs.end());
    const std::vector<AssignmentSolution> best = k_best_assignments(problem, k);
    ASSERT_EQ(best.size(), expected);
    std::set<std::vector<int>> distinct;
    for (std::size_t i = 0; i < best.size(); ++i) {
      ASSERT_NEAR(best[i].cost, costs[i], 1e-9);
      ASSERT_NEAR(cost_of(problem, best[i].entry), best[i].cost, 1e-9);
      distinct.insert(best[i].entry);
    }
    ASSERT_EQ(distinct.size(), best.size());
  }
}

TEST(KBest, EndsWhenThereAreNoMoreAssignments) {
  AssignmentProblem problem;
  problem.columns = 1;
  problem.row_begin = {0, 1, 2};
  problem.column = {0, 0};
  problem.cost = {1.0, 2.0};
  problem.unassigned_cost = {5.0, 5.0};
  const std::vector<AssignmentSolution> all = k_best_assignments(problem, 100);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_DOUBLE_EQ(all[0].cost, 6.0);
  EXPECT_DOUBLE_EQ(all[1].cost, 7.0);
  EXPECT_DOUBLE_EQ(all[2].cost, 10.0);
  EXPECT_THROW(k_best_assignments(problem, 0), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::association
