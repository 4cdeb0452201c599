// SPDX-License-Identifier: BSD-3-Clause
#include "residual_path.hpp"

#include <algorithm>
#include <functional>

#include "costs.hpp"

namespace helixnav::association {
namespace {

constexpr int fixed = -2;  // held by a row that keeps what it has

}  // namespace

ResidualPath::ResidualPath(const AssignmentProblem& problem)
    : problem_(problem),
      columns_(problem.columns + problem.rows()),
      row_of_column_(columns_),
      distance_(columns_),
      from_row_(columns_),
      from_entry_(columns_),
      done_(columns_) {}

bool ResidualPath::search(const AssignmentSolution& solution, int first_row, int row,
                          const std::vector<int>& forbidden) {
  solution_ = &solution;
  forbidden_ = &forbidden;
  first_row_ = first_row;
  start_row_ = row;
  target_ = column_of(problem_, row, solution.entry[row]);
  std::fill(row_of_column_.begin(), row_of_column_.end(), -1);
  for (int i = 0; i < problem_.rows(); ++i) {
    row_of_column_[column_of(problem_, i, solution.entry[i])] = i < first_row ? fixed : i;
  }
  std::fill(distance_.begin(), distance_.end(), infinity);
  std::fill(done_.begin(), done_.end(), char{0});
  open_.clear();
  sink_distance_ = infinity;
  sink_done_ = false;

  relax_row(row, 0.0);
  while (true) {
    const int column = nearest_column();
    const double column_distance = column < 0 ? infinity : distance_[column];
    if (!sink_done_ && sink_distance_ < infinity && sink_distance_ <= column_distance) {
      sink_done_ = true;
      relax_sink(sink_distance_);
      continue;
    }
    if (column < 0) return false;
    done_[column] = 1;
    if (column == target_) break;
    if (row_of_column_[column] >= 0) {
      relax_row(row_of_column_[column], column_distance);
    } else if (const double length = column_distance + solution.column_price[column]; length < sink_distance_) {
      // A free column's price is 0 up to rounding.
      sink_distance_ = std::max(length, column_distance);
      sink_from_ = column;
    }
  }
  length_ = distance_[target_];
  return true;
}

void ResidualPath::relax_row(int row, double length) {
  const double base = length - solution_->row_price[row];
  const auto allowed = [&](int entry) {
    return row != start_row_ || std::find(forbidden_->begin(), forbidden_->end(), entry) == forbidden_->end();
  };
  for (int e = problem_.row_begin[row]; e < problem_.row_begin[row + 1]; ++e) {
    const int c = problem_.column[e];
    if (allowed(e)) reach(c, std::max(length, base + problem_.cost[e] - solution_->column_price[c]), row, e);
  }
  const int none = problem_.columns + row;
  if (allowed(-1)) {
    reach(none, std::max(length, base + problem_.unassigned_cost[row] - solution_->column_price[none]), row, -1);
  }
}

void ResidualPath::relax_sink(double length) {
  for (int c = 0; c < columns_; ++c) {
    if (row_of_column_[c] >= 0) reach(c, std::max(length, length - solution_->column_price[c]), -1, -1);
  }
}

void ResidualPath::reach(int column, double length, int from_row, int from_entry) {
  if (done_[column] || row_of_column_[column] == fixed || length >= distance_[column]) return;
  distance_[column] = length;
  from_row_[column] = from_row;
  from_entry_[column] = from_entry;
  open_.emplace_back(length, column);
  std::push_heap(open_.begin(), open_.end(), std::greater<>());
}

/// Of those at the same distance the first.
int ResidualPath::nearest_column() {
  while (!open_.empty()) {
    const auto [distance, column] = open_.front();
    if (!done_[column] && distance == distance_[column]) return column;
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    open_.pop_back();
  }
  return -1;
}

AssignmentSolution ResidualPath::apply() const {
  AssignmentSolution changed = *solution_;
  int column = target_;
  while (true) {
    const int row = from_row_[column];
    if (row < 0) {  // released: the sink takes the column back from its row and gives it the free one
      column = sink_from_;
      continue;
    }
    changed.entry[row] = from_entry_[column];
    if (row == start_row_) break;
    column = column_of(problem_, row, solution_->entry[row]);
  }
  changed.cost = 0.0;
  for (int i = 0; i < problem_.rows(); ++i) changed.cost += entry_cost(problem_, i, changed.entry[i]);

  const double sink = std::min(sink_distance_, length_);
  for (int c = 0; c < columns_; ++c) {
    const double shift = std::min(distance_[c], length_);
    changed.column_price[c] += shift - sink;
    const int row = row_of_column_[c];
    if (row >= 0) changed.row_price[row] -= (row == start_row_ ? 0.0 : shift) - sink;
  }
  return changed;
}

}  // namespace helixnav::association
