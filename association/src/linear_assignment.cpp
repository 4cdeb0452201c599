// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/linear_assignment.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "costs.hpp"
#include "helixnav/core/errors.hpp"
#include "residual_path.hpp"

namespace helixnav::association {
namespace {

void check(const AssignmentProblem& problem) {
  const int rows = problem.rows();
  if (problem.row_begin.size() != problem.unassigned_cost.size() + 1 || problem.row_begin.front() != 0 ||
      problem.row_begin.back() != static_cast<int>(problem.cost.size()) ||
      problem.column.size() != problem.cost.size()) {
    throw core::PreconditionError("assignment: row_begin, column and cost do not fit together");
  }
  std::vector<int> last_row(problem.columns, -1);
  for (int i = 0; i < rows; ++i) {
    if (!std::isfinite(problem.unassigned_cost[i])) {
      throw core::PreconditionError("assignment: cost of leaving row " + std::to_string(i) + " alone is not finite");
    }
    for (int e = problem.row_begin[i]; e < problem.row_begin[i + 1]; ++e) {
      const int c = problem.column[e];
      if (c < 0 || c >= problem.columns || last_row[c] == i || !std::isfinite(problem.cost[e])) {
        throw core::PreconditionError("assignment: row " + std::to_string(i) + ", column " + std::to_string(c) +
                                      ", cost " + std::to_string(problem.cost[e]) +
                                      ": a finite cost and a column in range named once expected");
      }
      last_row[c] = i;
    }
  }
}

/// Working state: who holds each column, and the prices.
class Solver {
 public:
  explicit Solver(const AssignmentProblem& problem)
      : problem_(problem),
        rows_(problem.rows()),
        columns_(problem.columns + rows_),
        row_of_column_(columns_, -1),
        distance_(columns_),
        from_row_(columns_),
        from_entry_(columns_),
        scanned_(columns_) {
    solution_.entry.assign(rows_, unvisited);
    solution_.row_price.assign(rows_, 0.0);
    solution_.column_price.assign(columns_, 0.0);
  }

  AssignmentSolution solve() {
    std::vector<int> free_rows(rows_);
    for (int i = 0; i < rows_; ++i) free_rows[i] = rows_ - 1 - i;
    reduce(free_rows);
    for (const int row : free_rows) augment(row);
    for (int i = 0; i < rows_; ++i) solution_.cost += entry_cost(problem_, i, solution_.entry[i]);
    return std::move(solution_);
  }

 private:
  static constexpr int unvisited = -2;

  /// Augmenting row reduction: a row takes its cheapest column and lowers that column's price as far as its second
  /// choice allows; whoever held the column chooses again. Leaves in `free_rows` those that met a tie or ran out of
  /// tries.
  void reduce(std::vector<int>& free_rows) {
    std::vector<int> left;
    for (int tries = 4 * rows_; !free_rows.empty(); --tries) {
      const int row = free_rows.back();
      free_rows.pop_back();
      const Choice choice = two_cheapest(row);
      const int holder = row_of_column_[choice.column];
      if (holder >= 0 && (choice.second <= choice.first || tries <= 0)) {
        left.push_back(row);
        continue;
      }
      if (choice.column < problem_.columns && holder >= 0) {
        solution_.column_price[choice.column] -= choice.second - choice.first;
        solution_.row_price[row] = choice.second;
        solution_.entry[holder] = unvisited;
        free_rows.push_back(holder);
      } else {
        solution_.row_price[row] = choice.first;
      }
      give(row, choice.entry, choice.column);
    }
    free_rows = std::move(left);
  }

  struct Choice {
    double first = infinity;
    double second = infinity;
    int entry = -1;
    int column = 0;
  };
  Choice two_cheapest(int row) const {
    Choice choice;
    choice.first = problem_.unassigned_cost[row];
    choice.column = problem_.columns + row;
    for (int e = problem_.row_begin[row]; e < problem_.row_begin[row + 1]; ++e) {
      const double reduced = problem_.cost[e] - solution_.column_price[problem_.column[e]];
      if (reduced < choice.first) {
        choice.second = choice.first;
        choice.first = reduced;
        choice.entry = e;
        choice.column = problem_.column[e];
      } else if (reduced < choice.second) {
        choice.second = reduced;
      }
    }
    return choice;
  }

  void give(int row, int entry, int column) {
    solution_.entry[row] = entry;
    row_of_column_[column] = row;
  }

  /// Shortest augmenting path from a free row to a free column; prices follow so that the reduced costs stay ≥ 0.
  void augment(int start) {
    std::fill(distance_.begin(), distance_.end(), infinity);
    std::fill(scanned_.begin(), scanned_.end(), char{0});
    reached_.clear();
    solution_.row_price[start] = two_cheapest(start).first;
    int row = start;
    double length = 0.0;
    int column = -1;
    while (true) {
      relax(row, length);
      column = nearest_reached();
      length = distance_[column];
      if (row_of_column_[column] < 0) break;
      scanned_[column] = 1;
      row = row_of_column_[column];
    }
    update_prices(start, length);
    trace_back(start, column);
  }

  void relax(int row, double length) {
    const double base = length - solution_.row_price[row];
    for (int e = problem_.row_begin[row]; e < problem_.row_begin[row + 1]; ++e) {
      reach(row, e, problem_.column[e], base + problem_.cost[e]);
    }
    reach(row, -1, problem_.columns + row, base + problem_.unassigned_cost[row]);
  }
  void reach(int row, int entry, int column, double cost) {
    if (scanned_[column]) return;
    const double length = cost - solution_.column_price[column];
    if (length >= distance_[column]) return;
    if (distance_[column] == infinity) reached_.push_back(column);
    distance_[column] = length;
    from_row_[column] = row;
    from_entry_[column] = entry;
  }
  int nearest_reached() const {
    int best = -1;
    for (const int c : reached_) {
      if (!scanned_[c] && (best < 0 || distance_[c] < distance_[best])) best = c;
    }
    return best;  // never −1: each row's own "none" column is free or held by the row itself
  }
  void update_prices(int start, double length) {
    solution_.row_price[start] += length;
    for (const int c : reached_) {
      if (!scanned_[c]) continue;
      solution_.row_price[row_of_column_[c]] += length - distance_[c];
      solution_.column_price[c] -= length - distance_[c];
    }
  }
  void trace_back(int start, int column) {
    while (true) {
      const int row = from_row_[column];
      const int before = solution_.entry[row];
      give(row, from_entry_[column], column);
      if (row == start) return;
      column = column_of(problem_, row, before);
    }
  }

  const AssignmentProblem& problem_;
  int rows_;
  int columns_;
  AssignmentSolution solution_;
  std::vector<int> row_of_column_;
  std::vector<double> distance_;
  std::vector<int> from_row_;
  std::vector<int> from_entry_;
  std::vector<char> scanned_;
  std::vector<int> reached_;
};

}  // namespace

AssignmentSolution solve_assignment(const AssignmentProblem& problem) {
  check(problem);
  return Solver(problem).solve();
}

std::vector<double> assignment_margins(const AssignmentProblem& problem, const AssignmentSolution& solution) {
  std::vector<double> margins(problem.rows());
  ResidualPath path(problem);
  for (int i = 0; i < problem.rows(); ++i) {
    margins[i] = path.search(solution, 0, i, {solution.entry[i]}) ? path.length() : infinity;
  }
  return margins;
}

}  // namespace helixnav::association
