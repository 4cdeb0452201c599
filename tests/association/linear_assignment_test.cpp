// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/linear_assignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "enumeration.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::association {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

void expect_valid(const AssignmentProblem& problem, const std::vector<int>& entry) {
  std::vector<int> holders(problem.columns, 0);
  for (int row = 0; row < problem.rows(); ++row) {
    if (entry[row] < 0) continue;
    ASSERT_GE(entry[row], problem.row_begin[row]);
    ASSERT_LT(entry[row], problem.row_begin[row + 1]);
    ASSERT_EQ(++holders[problem.column[entry[row]]], 1);
  }
}

/// Prices never above any cost, tight where assigned, columns' prices at most 0 and 0 where free: optimal by duality.
void expect_certificate(const AssignmentProblem& problem, const AssignmentSolution& s) {
  std::vector<char> held(problem.columns + problem.rows(), 0);
  for (int row = 0; row < problem.rows(); ++row) {
    const int none = problem.columns + row;
    EXPECT_LE(s.row_price[row] + s.column_price[none], problem.unassigned_cost[row] + 1e-9);
    for (int e = problem.row_begin[row]; e < problem.row_begin[row + 1]; ++e) {
      EXPECT_LE(s.row_price[row] + s.column_price[problem.column[e]], problem.cost[e] + 1e-9);
    }
    const int column = s.entry[row] < 0 ? none : problem.column[s.entry[row]];
    const double cost = s.entry[row] < 0 ? problem.unassigned_cost[row] : problem.cost[s.entry[row]];
    EXPECT_NEAR(s.row_price[row] + s.column_price[column], cost, 1e-9);
    held[column] = 1;
  }
  for (std::size_t c = 0; c < held.size(); ++c) {
    EXPECT_LE(s.column_price[c], 1e-12);
    EXPECT_TRUE(held[c] || s.column_price[c] == 0.0);
  }
}

TEST(LinearAssignment, EqualsBruteForceOnTwentyThousandProblemsUpToSixBySix) {
  core::RandomStream random(1, "assignment");
  for (int t = 0; t < 20'000; ++t) {
    const AssignmentProblem problem = random_assignment_problem(random);
    double best = infinity;
    for_each_assignment(problem, [&](const std::vector<int>& e) { best = std::min(best, cost_of(problem, e)); });
    const AssignmentSolution solution = solve_assignment(problem);
    ASSERT_NEAR(solution.cost, best, 1e-9);
    ASSERT_NEAR(cost_of(problem, solution.entry), best, 1e-9);
    expect_valid(problem, solution.entry);
  }
}

TEST(LinearAssignment, ProvesItselfOptimalOnLargeProblemsByItsPrices) {
  core::RandomStream random(2, "certificate");
  for (int t = 0; t < 200; ++t) {
    AssignmentProblem problem;
    problem.columns = 60;
    for (int row = 0; row < 50; ++row) {
      for (int c = 0; c < problem.columns; ++c) {
        if (!random.bernoulli(0.3)) continue;
        problem.column.push_back(c);
        problem.cost.push_back(t % 2 == 0 ? random.normal() : static_cast<double>(random.below(5)));
      }
      problem.row_begin.push_back(static_cast<int>(problem.cost.size()));
      problem.unassigned_cost.push_back(1.0);
    }
    const AssignmentSolution solution = solve_assignment(problem);
    expect_valid(problem, solution.entry);
    expect_certificate(problem, solution);
  }
}

TEST(LinearAssignment, MarginsEqualBruteForceWithoutThePairChosen) {
  core::RandomStream random(3, "margins");
  for (int t = 0; t < 5'000; ++t) {
    const AssignmentProblem problem = random_assignment_problem(random);
    const AssignmentSolution solution = solve_assignment(problem);
    std::vector<double> other(problem.rows(), infinity);
    for_each_assignment(problem, [&](const std::vector<int>& e) {
      const double cost = cost_of(problem, e);
      for (int row = 0; row < problem.rows(); ++row) {
        if (e[row] != solution.entry[row]) other[row] = std::min(other[row], cost);
      }
    });
    const std::vector<double> margins = assignment_margins(problem, solution);
    for (int row = 0; row < problem.rows(); ++row) {
      if (std::isinf(other[row])) {
        ASSERT_EQ(margins[row], infinity);
      } else {
        ASSERT_NEAR(margins[row], other[row] - solution.cost, 1e-9);
      }
    }
  }
}

TEST(LinearAssignment, RefusesCostsThatAreNoNumbersAndMalformedProblems) {
  AssignmentProblem good;
  good.columns = 2;
  good.row_begin = {0, 2};
  good.column = {0, 1};
  good.cost = {1.0, 2.0};
  good.unassigned_cost = {0.0};
  EXPECT_NO_THROW(solve_assignment(good));
  for (const double bad : {std::nan(""), infinity, -infinity}) {
    AssignmentProblem p = good;
    p.cost[1] = bad;
    EXPECT_THROW(solve_assignment(p), core::PreconditionError);
    p = good;
    p.unassigned_cost[0] = bad;
    EXPECT_THROW(solve_assignment(p), core::PreconditionError);
  }
  AssignmentProblem twice = good;
  twice.column[1] = 0;
  EXPECT_THROW(solve_assignment(twice), core::PreconditionError);
  AssignmentProblem outside = good;
  outside.column[1] = 2;
  EXPECT_THROW(solve_assignment(outside), core::PreconditionError);
  AssignmentProblem short_rows = good;
  short_rows.row_begin = {0, 1};
  EXPECT_THROW(solve_assignment(short_rows), core::PreconditionError);
}

}  // namespace
}  // namespace helixnav::association
