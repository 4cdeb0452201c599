// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/ihgr.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "matching.hpp"
#include "residual_path.hpp"

namespace helixnav::association {
namespace {

constexpr double whole = 1e-6;       // nearer than this to 0 or 1 is 0 or 1
constexpr double predominant = 0.5;  // above it a variable has no equal in its row and column
constexpr int undecided = -2;

/// Rounding in progress: rows still undecided, columns still free, and the x of what is left.
struct Rounding {
  const AssignmentProblem& problem;
  std::vector<double> x;
  std::vector<int> entry;
  std::vector<char> taken;
  RoundedAssignment result;

  void decide(int row, int e) {
    entry[row] = e;
    if (e >= 0) taken[problem.column[e]] = 1;
  }
  bool is_open(int row, int e) const { return entry[row] == undecided && !taken[problem.column[e]]; }
  double dummy(int row) const {
    double rest = 1.0;
    for (int e = problem.row_begin[row]; e < problem.row_begin[row + 1]; ++e) rest -= x[e];
    return rest;
  }
};

/// Keeps what is whole-numbered: rows with a variable, or their dummy, at 1.
void keep_whole(Rounding& r) {
  for (int row = 0; row < r.problem.rows(); ++row) {
    if (r.entry[row] != undecided) continue;
    for (int e = r.problem.row_begin[row]; e < r.problem.row_begin[row + 1]; ++e) {
      if (r.x[e] >= 1.0 - whole) r.decide(row, e);
    }
    if (r.entry[row] == undecided && r.dummy(row) >= 1.0 - whole) r.decide(row, -1);
  }
}

/// The largest variable of the rows left, a dummy's included.
struct Largest {
  int row = -1;
  int entry = -1;
  double x = -1.0;
};
Largest largest(const Rounding& r) {
  Largest best;
  for (int row = 0; row < r.problem.rows(); ++row) {
    if (r.entry[row] != undecided) continue;
    for (int e = r.problem.row_begin[row]; e < r.problem.row_begin[row + 1]; ++e) {
      if (r.is_open(row, e) && r.x[e] > best.x) best = {row, e, r.x[e]};
    }
    if (const double rest = r.dummy(row); rest > best.x) best = {row, -1, rest};
  }
  return best;
}

/// The linear programme of the rows and columns left.
void solve_rest(Rounding& r) {
  AssignmentProblem rest;
  rest.columns = r.problem.columns;
  std::vector<int> entry_of_rest;
  for (int row = 0; row < r.problem.rows(); ++row) {
    if (r.entry[row] != undecided) continue;
    for (int e = r.problem.row_begin[row]; e < r.problem.row_begin[row + 1]; ++e) {
      r.x[e] = 0.0;
      if (!r.is_open(row, e)) continue;
      rest.column.push_back(r.problem.column[e]);
      rest.cost.push_back(r.problem.cost[e]);
      entry_of_rest.push_back(e);
    }
    rest.row_begin.push_back(static_cast<int>(rest.cost.size()));
    rest.unassigned_cost.push_back(r.problem.unassigned_cost[row]);
  }
  const std::vector<double> x = relaxed_assignment(rest);
  for (std::size_t k = 0; k < x.size(); ++k) r.x[entry_of_rest[k]] = x[k];
}

/// The tie rule: every combination of the nonzero variables is tried, the cheapest is kept. Depth first, so that even a
/// spent budget leaves a feasible one.
class TieSearch {
 public:
  TieSearch(Rounding& rounding, std::int64_t budget) : r_(rounding), budget_(budget) {
    for (int row = 0; row < r_.problem.rows(); ++row) {
      if (r_.entry[row] == undecided) rows_.push_back(row);
    }
    current_.assign(rows_.size(), -1);
  }

  void run() {
    descend(0, 0.0);
    for (std::size_t k = 0; k < rows_.size(); ++k) r_.decide(rows_[k], best_[k]);
    r_.result.roundings += static_cast<int>(rows_.size());
    r_.result.combinations += combinations_;
    r_.result.budget_hit = combinations_ >= budget_;
  }

 private:
  void descend(std::size_t k, double cost) {
    if (combinations_ >= budget_) return;
    if (k == rows_.size()) {
      ++combinations_;
      if (cost < best_cost_) {
        best_cost_ = cost;
        best_ = current_;
      }
      return;
    }
    const int row = rows_[k];
    for (int e = r_.problem.row_begin[row]; e < r_.problem.row_begin[row + 1]; ++e) {
      if (r_.x[e] <= whole || r_.taken[r_.problem.column[e]]) continue;
      r_.taken[r_.problem.column[e]] = 1;
      current_[k] = e;
      descend(k + 1, cost + r_.problem.cost[e]);
      r_.taken[r_.problem.column[e]] = 0;
    }
    current_[k] = -1;  // the dummy is possible whatever the others took
    descend(k + 1, cost + r_.problem.unassigned_cost[row]);
  }

  Rounding& r_;
  std::int64_t budget_;
  std::int64_t combinations_ = 0;
  std::vector<int> rows_;
  std::vector<int> current_;
  std::vector<int> best_;
  double best_cost_ = std::numeric_limits<double>::infinity();
};

void check_feasible(const AssignmentProblem& problem, const std::vector<double>& x) {
  bool feasible = x.size() == problem.cost.size();
  std::vector<double> column_sum(problem.columns, 0.0);
  for (int row = 0; feasible && row < problem.rows(); ++row) {
    double sum = 0.0;
    for (int e = problem.row_begin[row]; e < problem.row_begin[row + 1]; ++e) {
      feasible = feasible && x[e] >= -whole;
      sum += x[e];
      column_sum[problem.column[e]] += x[e];
    }
    feasible = feasible && sum <= 1.0 + whole;
  }
  for (const double sum : column_sum) feasible = feasible && sum <= 1.0 + whole;
  if (!feasible) throw core::PreconditionError("round_greedily: x does not satisfy the assignment constraints");
}

}  // namespace

PublishedProblem ihgr_published_costs(const InnovationProblem& problem) {
  PublishedProblem published;
  published.assignment.columns = static_cast<int>(problem.ids.size());
  for (const GatedObservation& observation : problem.observations) {
    for (int p = observation.begin; p < observation.end && problem.pairs[p].nis <= ihgr_published_gate; ++p) {
      published.assignment.column.push_back(problem.pairs[p].candidate);
      published.assignment.cost.push_back(-problem.pairs[p].log_likelihood);
      published.pair_of_entry.push_back(p);
    }
    published.assignment.row_begin.push_back(static_cast<int>(published.assignment.cost.size()));
    published.assignment.unassigned_cost.push_back(0.0);
  }
  return published;
}

RoundedAssignment round_greedily(const AssignmentProblem& problem, std::vector<double> x,
                                 std::int64_t combination_budget) {
  check_feasible(problem, x);
  if (combination_budget < 1) throw core::PreconditionError("round_greedily: combination_budget must be at least 1");
  Rounding r{
      problem, std::move(x), std::vector<int>(problem.rows(), undecided), std::vector<char>(problem.columns, 0), {}};
  keep_whole(r);
  for (Largest next = largest(r); next.row >= 0; next = largest(r)) {
    if (next.x <= predominant + whole) {
      TieSearch(r, combination_budget).run();
      break;
    }
    r.decide(next.row, next.entry);
    ++r.result.roundings;
    solve_rest(r);
    keep_whole(r);
  }
  for (int row = 0; row < problem.rows(); ++row) r.result.cost += entry_cost(problem, row, r.entry[row]);
  r.result.entry = std::move(r.entry);
  return std::move(r.result);
}

Matching ihgr_published(const InnovationProblem& problem, std::int64_t combination_budget) {
  const PublishedProblem published = ihgr_published_costs(problem);
  const RoundedAssignment rounded =
      round_greedily(published.assignment, relaxed_assignment(published.assignment), combination_budget);
  Matching matching;
  for (const int entry : rounded.entry) matching.pair.push_back(entry < 0 ? unmatched : published.pair_of_entry[entry]);
  matching.nodes = rounded.combinations;
  matching.budget_hit = rounded.budget_hit;
  matching.roundings = rounded.roundings;
  return matching;
}

Matching ihgr_likelihood_ratio(const AssignmentProblem& costs, std::int64_t combination_budget) {
  RoundedAssignment rounded = round_greedily(costs, relaxed_assignment(costs), combination_budget);
  Matching matching;
  matching.pair = std::move(rounded.entry);
  matching.nodes = rounded.combinations;
  matching.budget_hit = rounded.budget_hit;
  matching.roundings = rounded.roundings;
  return matching;
}

}  // namespace helixnav::association
