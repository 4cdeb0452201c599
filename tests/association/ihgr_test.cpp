// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/ihgr.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "enumeration.hpp"
#include "helixnav/association/associate.hpp"
#include "helixnav/association/likelihood_ratio.hpp"
#include "helixnav/core/errors.hpp"
#include "scenes.hpp"

namespace helixnav::association {
namespace {

TEST(Ihgr, TheRelaxationsVertexIsWholeNumberedAndOptimalSoThatRoundingNeverRuns) {
  core::RandomStream random(5, "lp");
  for (int t = 0; t < 10'000; ++t) {
    const AssignmentProblem problem = random_assignment_problem(random);
    const std::vector<double> x = relaxed_assignment(problem);
    for (const double value : x) ASSERT_LT(std::min(std::abs(value), std::abs(value - 1.0)), 1e-7);
    const RoundedAssignment rounded = round_greedily(problem, x, 1000);
    ASSERT_EQ(rounded.roundings, 0);
    ASSERT_NEAR(rounded.cost, solve_assignment(problem).cost, 1e-7);
  }
}

/// Two observations that two landmarks explain equally well: every x between the two vertices is optimal, and an interior
/// point method without crossover ends in the middle.
AssignmentProblem tie(int size) {
  AssignmentProblem problem;
  problem.columns = size;
  for (int row = 0; row < size; ++row) {
    for (int c = 0; c < size; ++c) {
      problem.column.push_back(c);
      problem.cost.push_back(-4.0);
    }
    problem.row_begin.push_back(size * (row + 1));
    problem.unassigned_cost.push_back(0.0);
  }
  return problem;
}

TEST(Ihgr, RoundsAnInteriorSolutionOfATieByPricingAllCombinations) {
  for (const int size : {2, 3, 4}) {
    const AssignmentProblem problem = tie(size);
    const RoundedAssignment rounded = round_greedily(problem, std::vector<double>(size * size, 1.0 / size), 100'000);
    EXPECT_EQ(rounded.roundings, size);
    EXPECT_GT(rounded.combinations, 1);
    EXPECT_FALSE(rounded.budget_hit);
    EXPECT_DOUBLE_EQ(rounded.cost, -4.0 * size);
  }
}

TEST(Ihgr, RoundsTheVariableThatStandsOutAndSolvesTheRestAgain) {
  const AssignmentProblem problem = tie(3);
  const std::vector<double> x = {0.8, 0.1, 0.1, 0.1, 0.45, 0.45, 0.1, 0.45, 0.45};
  const RoundedAssignment rounded = round_greedily(problem, x, 100'000);
  EXPECT_EQ(rounded.entry[0], 0);
  EXPECT_EQ(rounded.roundings, 1);
  EXPECT_EQ(rounded.combinations, 0);
  EXPECT_DOUBLE_EQ(rounded.cost, -12.0);
}

TEST(Ihgr, EndsFeasibleFromAnyFeasibleStart) {
  core::RandomStream random(6, "rounding");
  for (int t = 0; t < 2'000; ++t) {
    const AssignmentProblem problem = random_assignment_problem(random);
    std::vector<double> x(problem.cost.size());
    for (double& value : x) value = random.uniform() / 6.0;
    const RoundedAssignment rounded = round_greedily(problem, x, 100'000);
    std::vector<int> holders(problem.columns, 0);
    for (const int e : rounded.entry) {
      if (e < 0) continue;
      ASSERT_EQ(++holders[problem.column[e]], 1);
    }
    ASSERT_NEAR(rounded.cost, cost_of(problem, rounded.entry), 1e-12);
    ASSERT_GE(rounded.cost, solve_assignment(problem).cost - 1e-9);
  }
}

TEST(Ihgr, KeepsAFeasibleRoundingWhenTheBudgetEnds) {
  const AssignmentProblem problem = tie(9);
  const RoundedAssignment rounded = round_greedily(problem, std::vector<double>(81, 1.0 / 9), 50);
  EXPECT_TRUE(rounded.budget_hit);
  EXPECT_EQ(rounded.combinations, 50);
  EXPECT_EQ(rounded.entry.size(), 9u);
}

TEST(Ihgr, RefusesAnInfeasibleStart) {
  EXPECT_THROW(round_greedily(tie(2), {1.0, 0.5, 0.0, 0.0}, 10), core::PreconditionError);
  EXPECT_THROW(round_greedily(tie(2), {1.0, 0.0, 1.0, 0.0}, 10), core::PreconditionError);
  EXPECT_THROW(round_greedily(tie(2), {-0.5, 0.0, 0.0, 0.0}, 10), core::PreconditionError);
  EXPECT_THROW(round_greedily(tie(2), {std::nan(""), 0.0, 0.0, 0.0}, 10), core::PreconditionError);
  EXPECT_THROW(round_greedily(tie(2), {1.0}, 10), core::PreconditionError);
}

TEST(Ihgr, WithLikelihoodRatiosEqualsTheOptimalAssignment) {
  core::RandomStream random(7, "lr lp");
  Options options;
  options.joint_test = false;
  int roundings = 0;
  for (int t = 0; t < 1'000; ++t) {
    const Scene scene = crowded_scene(random, 6, 8, 0.3);
    const InnovationProblem problem = make_innovation_problem(scene.map, scene.scan);
    const Assignment lp = associate(Method::ihgr_likelihood_ratio, problem, options);
    const Assignment optimal = associate(Method::likelihood_ratio, problem, options);
    ASSERT_EQ(lp.pairs, optimal.pairs);
    roundings += lp.roundings;
  }
  EXPECT_EQ(roundings, 0);
}

TEST(Ihgr, PublishedLeavesPairsBeyondItsGateAlone) {
  core::RandomStream random(8, "gate");
  int beyond = 0;
  for (int t = 0; t < 300; ++t) {
    const Scene scene = crowded_scene(random, 6, 8, 0.3);
    const InnovationProblem problem = make_innovation_problem(scene.map, scene.scan);
    for (const int p : associate(Method::ihgr_published, problem).pairs) {
      EXPECT_LE(problem.pairs[p].nis, ihgr_published_gate);
    }
    for (const GatedPair& pair : problem.pairs) beyond += pair.nis > ihgr_published_gate;
  }
  EXPECT_GT(beyond, 100);
}

}  // namespace
}  // namespace helixnav::association
