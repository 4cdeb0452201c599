// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>

#include <ClpSimplex.hpp>

#include "helixnav/association/ihgr.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::association {

std::vector<double> relaxed_assignment(const AssignmentProblem& problem) {
  const int rows = problem.rows();
  const int entries = static_cast<int>(problem.cost.size());
  if (entries == 0) return {};
  // A dummy is the slack of its row or column, so x = 0 is a feasible basis and costs count from the row's dummy.
  std::vector<CoinBigIndex> start(entries + 1);
  std::vector<int> row_index(2 * entries);
  std::vector<double> value(2 * entries, 1.0);
  std::vector<double> cost(entries);
  for (int row = 0; row < rows; ++row) {
    for (int e = problem.row_begin[row]; e < problem.row_begin[row + 1]; ++e) {
      start[e + 1] = 2 * (e + 1);
      row_index[2 * e] = row;
      row_index[2 * e + 1] = rows + problem.column[e];
      cost[e] = problem.cost[e] - problem.unassigned_cost[row];
    }
  }
  const int constraints = rows + problem.columns;
  const std::vector<double> lower(std::max(constraints, entries), 0.0);
  const std::vector<double> upper(std::max(constraints, entries), 1.0);
  ClpSimplex clp;
  clp.setLogLevel(0);
  clp.loadProblem(entries, constraints, start.data(), row_index.data(), value.data(), lower.data(), upper.data(),
                  cost.data(), lower.data(), upper.data());
  clp.primal();
  if (clp.status() != 0) {
    throw core::NumericalError("ihgr: CLP ended with status " + std::to_string(clp.status()) + " on " +
                               std::to_string(rows) + " observations and " + std::to_string(entries) + " pairs");
  }
  return {clp.primalColumnSolution(), clp.primalColumnSolution() + entries};
}

}  // namespace helixnav::association
