// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/k_best.hpp"

#include <queue>
#include <string>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "residual_path.hpp"

namespace helixnav::association {
namespace {

/// The best of all assignments in which the rows before `first_row` are as here and row `first_row` uses none of
/// `forbidden`.
struct Part {
  AssignmentSolution best;
  int first_row = 0;
  std::vector<int> forbidden;
  long order = 0;  // of creation, so that ties are broken the same way everywhere
};

struct Dearer {
  bool operator()(const Part& a, const Part& b) const {
    return a.best.cost != b.best.cost ? a.best.cost > b.best.cost : a.order > b.order;
  }
};

using Queue = std::priority_queue<Part, std::vector<Part>, Dearer>;

/// Everything in the part except its best, as disjoint parts: row by row, the rows before as in the best, this one
/// different.
void split(const Part& part, ResidualPath& path, long& created, Queue& queue) {
  const int rows = static_cast<int>(part.best.entry.size());
  for (int row = part.first_row; row < rows; ++row) {
    std::vector<int> forbidden = row == part.first_row ? part.forbidden : std::vector<int>{};
    forbidden.push_back(part.best.entry[row]);
    if (path.search(part.best, row, row, forbidden)) queue.push({path.apply(), row, std::move(forbidden), ++created});
  }
}

}  // namespace

std::vector<AssignmentSolution> k_best_assignments(const AssignmentProblem& problem, int k) {
  if (k < 1) throw core::PreconditionError("k_best_assignments: k must be at least 1, got " + std::to_string(k));
  std::vector<AssignmentSolution> best;
  Queue queue;
  long created = 0;
  queue.push({solve_assignment(problem), 0, {}, created});
  ResidualPath path(problem);
  while (!queue.empty()) {
    const Part part = queue.top();
    queue.pop();
    best.push_back(part.best);
    if (static_cast<int>(best.size()) == k) break;
    split(part, path, created, queue);
  }
  return best;
}

}  // namespace helixnav::association
