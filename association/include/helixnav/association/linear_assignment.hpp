// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace helixnav::association {

/// Assignment of columns (landmarks) to rows (observations), each column at most once; a row may stay unassigned at its
/// own cost. Sparse: row i may take the columns column[row_begin[i] … row_begin[i+1]−1] at the corresponding costs.
struct AssignmentProblem {
  int columns = 0;
  std::vector<int> row_begin = {0};
  std::vector<int> column;
  std::vector<double> cost;
  std::vector<double> unassigned_cost;  ///< one for each row

  int rows() const { return static_cast<int>(unassigned_cost.size()); }
};

/// The cheapest assignment with the dual prices that prove it optimal.
struct AssignmentSolution {
  std::vector<int> entry;  ///< for each row, the index into AssignmentProblem::column, or −1 for none
  double cost = 0.0;
  /// Dual prices: row_price[i] + column_price[j] ≤ cost of (i, j), with equality where assigned; column_price ≤ 0, and 0
  /// where free. The last rows() column prices belong to the rows' private "none" columns.
  std::vector<double> row_price;
  std::vector<double> column_price;
};

/// Minimum-cost assignment by augmenting row reduction and shortest augmenting paths after Jonker and Volgenant (1987),
/// on the sparse rectangular problem with one private dummy column for each row.
/// Cost O(rows × entries) at worst; microseconds for a scan. Throws PreconditionError for NaN or infinite costs and for
/// a column that is out of range or listed twice in the same row.
/// Test: association/linear_assignment_test.cpp (brute force, dual certificate).
AssignmentSolution solve_assignment(const AssignmentProblem& problem);

/// For each row, how much more the best assignment costs if the row may not keep what `solution` gave it; +inf if it
/// has no alternative. One shortest path for each row, from the prices of the solution.
/// Test: association/linear_assignment_test.cpp (brute force).
std::vector<double> assignment_margins(const AssignmentProblem& problem, const AssignmentSolution& solution);

}  // namespace helixnav::association
