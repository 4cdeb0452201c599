// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "helixnav/association/linear_assignment.hpp"

namespace helixnav::association {

/// Entry −1 is the row's private "none" column, which comes after the landmarks' columns.
inline int column_of(const AssignmentProblem& problem, int row, int entry) {
  return entry < 0 ? problem.columns + row : problem.column[entry];
}
inline double entry_cost(const AssignmentProblem& problem, int row, int entry) {
  return entry < 0 ? problem.unassigned_cost[row] : problem.cost[entry];
}

/// The cheapest change of an optimal assignment that takes from one row what it has: the shortest cycle through that pair
/// in the residual graph of the flow formulation (rows → columns → sink), found by Dijkstra on the reduced costs, which
/// the optimal prices make nonnegative.
class ResidualPath {
 public:
  explicit ResidualPath(const AssignmentProblem& problem);

  /// Rows before `first_row` keep what they have; `row` (≥ first_row) may use none of the entries in `forbidden`, which
  /// include its own. False when nothing else is possible.
  bool search(const AssignmentSolution& solution, int first_row, int row, const std::vector<int>& forbidden);

  double length() const { return length_; }  ///< by how much the cost of the assignment rises; ≥ 0

  /// The changed assignment with prices that prove it among the rows from `first_row` on.
  AssignmentSolution apply() const;

 private:
  void relax_row(int row, double length);
  void relax_sink(double length);
  void reach(int column, double length, int from_row, int from_entry);
  int nearest_column();

  const AssignmentProblem& problem_;
  int columns_;
  const AssignmentSolution* solution_ = nullptr;
  const std::vector<int>* forbidden_ = nullptr;
  int first_row_ = 0;
  int start_row_ = 0;
  int target_ = 0;
  double length_ = 0.0;
  double sink_distance_ = 0.0;
  int sink_from_ = -1;
  bool sink_done_ = false;
  std::vector<int> row_of_column_;
  std::vector<double> distance_;
  std::vector<int> from_row_;  // row that reached the column, or −1 for the sink
  std::vector<int> from_entry_;
  std::vector<char> done_;
  std::vector<std::pair<double, int>> open_;  // heap of distances and columns, some of them superseded
};

}  // namespace helixnav::association
