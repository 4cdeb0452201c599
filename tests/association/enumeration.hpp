// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "helixnav/association/linear_assignment.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::association {

/// Brute force: calls `visit(entries)` for every possible assignment; −1 means none.
inline void for_each_assignment(const AssignmentProblem& problem,
                                const std::function<void(const std::vector<int>&)>& visit) {
  std::vector<int> entry(problem.rows(), -1);
  std::vector<char> taken(problem.columns, 0);
  const std::function<void(int)> descend = [&](int row) {
    if (row == problem.rows()) return visit(entry);
    entry[row] = -1;
    descend(row + 1);
    for (int e = problem.row_begin[row]; e < problem.row_begin[row + 1]; ++e) {
      if (taken[problem.column[e]]) continue;
      taken[problem.column[e]] = 1;
      entry[row] = e;
      descend(row + 1);
      taken[problem.column[e]] = 0;
    }
    entry[row] = -1;
  };
  descend(0);
}

inline double cost_of(const AssignmentProblem& problem, const std::vector<int>& entry) {
  double cost = 0.0;
  for (int row = 0; row < problem.rows(); ++row) {
    cost += entry[row] < 0 ? problem.unassigned_cost[row] : problem.cost[entry[row]];
  }
  return cost;
}

/// Up to 6×6, any share of the pairs gated, costs of both signs; one problem in four has integer costs and therefore
/// many ties.
inline AssignmentProblem random_assignment_problem(core::RandomStream& random) {
  AssignmentProblem problem;
  const int rows = static_cast<int>(random.below(7));
  problem.columns = static_cast<int>(random.below(7));
  const double density = random.uniform(0.2, 1.0);
  const bool ties = random.bernoulli(0.25);
  const auto draw = [&] { return ties ? static_cast<double>(random.below(4)) - 2.0 : random.normal(-1.0, 3.0); };
  for (int row = 0; row < rows; ++row) {
    for (int c = 0; c < problem.columns; ++c) {
      if (!random.bernoulli(density)) continue;
      problem.column.push_back(c);
      problem.cost.push_back(draw());
    }
    problem.row_begin.push_back(static_cast<int>(problem.cost.size()));
    problem.unassigned_cost.push_back(draw());
  }
  return problem;
}

}  // namespace helixnav::association
