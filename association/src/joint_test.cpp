// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>

#include "costs.hpp"
#include "helixnav/association/chi2_table.hpp"
#include "helixnav/association/joint_innovation.hpp"
#include "helixnav/association/k_best.hpp"
#include "joint_factor.hpp"
#include "joint_shares.hpp"
#include "matching.hpp"

namespace helixnav::association {
namespace {

bool passes(const JointNis& joint, const Options& options) {
  return joint.dof == 0 || joint.nis <= chi2_threshold(options.joint_probability, joint.dof);
}

/// −ln of the posterior odds of the whole set against nothing matched, with the covariances between pairs.
double joint_cost(const JointNis& joint, const AssignmentProblem& costs, const InnovationProblem& problem,
                  const std::vector<int>& pair) {
  double cost = -joint.log_likelihood;
  for (std::size_t i = 0; i < pair.size(); ++i) {
    if (pair[i] == unmatched) {
      cost += costs.unassigned_cost[i];
    } else {  // leaves −ln(P_D/(1−P_D)) of the pair's own cost
      cost += costs.cost[pair[i]] + problem.pairs[pair[i]].log_likelihood;
    }
  }
  return cost;
}

struct Passing {
  std::vector<int> pair;
  JointNis joint;
  int alternative;
  double cost;
};

/// Pairs common to all assignments.
std::vector<int> common_pairs(const std::vector<AssignmentSolution>& solutions) {
  std::vector<int> common = solutions.front().entry;
  for (const AssignmentSolution& one : solutions) {
    for (std::size_t i = 0; i < common.size(); ++i) {
      if (one.entry[i] != common[i]) common[i] = unmatched;
    }
  }
  return common;
}

/// Joint NIS of assignments that differ in few pairs: what they have in common is factored once, O(n³), and each costs O(n²) for
/// each additional pair.
class NeighbouringNis {
 public:
  NeighbouringNis(const InnovationProblem& problem, const std::vector<AssignmentSolution>& solutions)
      : problem_(problem), common_(common_pairs(solutions)), factor_(problem, common_.size()) {
    for (const int pair : matched_pairs(common_)) add(pair, common_nis_);
  }

  /// Of one of the solutions.
  JointNis operator()(const std::vector<int>& pair) {
    JointNis joint = common_nis_;
    const std::size_t kept = factor_.pairs().size();
    for (std::size_t i = 0; i < pair.size(); ++i) {
      if (pair[i] != common_[i]) add(pair[i], joint);
    }
    while (factor_.pairs().size() > kept) factor_.drop();
    return joint;
  }

 private:
  void add(int pair, JointNis& joint) {
    if (pair == unmatched) return;
    const Increment increment = factor_.weigh(pair);
    factor_.keep(pair);
    const int dof = problem_.pairs[pair].dof;
    joint.nis += increment.nis;
    joint.dof += dof;
    joint.log_likelihood -= 0.5 * (increment.nis + increment.log_determinant + dof * ln_2pi);
  }

  const InnovationProblem& problem_;
  std::vector<int> common_;
  JointFactor factor_;
  JointNis common_nis_;
};

/// The best passing one of the next-best assignments.
std::optional<Passing> best_alternative(const InnovationProblem& problem, const AssignmentProblem& costs,
                                        const Options& options) {
  std::optional<Passing> best;
  if (options.joint_alternatives < 1) return best;
  const std::vector<AssignmentSolution> solutions = k_best_assignments(costs, options.joint_alternatives + 1);
  if (solutions.size() < 2) return best;
  NeighbouringNis nis_of(problem, solutions);
  for (std::size_t k = 1; k < solutions.size(); ++k) {
    const std::vector<int>& pair = solutions[k].entry;  // entry e of the costs is pair e, −1 is unmatched
    JointNis joint = nis_of(pair);
    if (!passes(joint, options)) continue;
    const double cost = joint_cost(joint, costs, problem, pair);
    if (!best || cost < best->cost) best = {pair, std::move(joint), static_cast<int>(k), cost};
  }
  return best;
}

}  // namespace

std::vector<int> matched_pairs(const std::vector<int>& pair_of_observation) {
  std::vector<int> pairs;
  pairs.reserve(pair_of_observation.size());
  for (const int p : pair_of_observation) {
    if (p != unmatched) pairs.push_back(p);
  }
  return pairs;
}

Guarded guard_by_dropping(const InnovationProblem& problem, const std::vector<int>& pair, const Options& options) {
  Guarded guarded;
  guarded.pair = pair;
  guarded.dropped.assign(pair.size(), unmatched);
  const std::vector<int> pairs = matched_pairs(pair);
  JointNis joint = joint_nis(problem, pairs);
  guarded.first_nis = joint.nis;
  guarded.first_dof = joint.dof;
  if (options.joint_test && !passes(joint, options)) {
    JointShares rest(problem, pairs);
    while (!passes(joint, options)) {
      const std::size_t worst = rest.worst();
      const GatedPair& dropped = problem.pairs[pairs[worst]];
      guarded.dropped[dropped.observation] = pairs[worst];
      guarded.pair[dropped.observation] = unmatched;
      joint.nis -= rest.drop(worst);
      joint.dof -= dropped.dof;
    }
  }
  guarded.nis = joint.nis;
  guarded.dof = joint.dof;
  return guarded;
}

Guarded guard_by_alternatives(const InnovationProblem& problem, const AssignmentProblem& costs,
                              const std::vector<int>& pair, const Options& options) {
  Guarded dropped = guard_by_dropping(problem, pair, options);
  if (dropped.pair == pair) return dropped;
  std::optional<Passing> other = best_alternative(problem, costs, options);
  if (!other) return dropped;
  const JointNis rest = joint_nis(problem, matched_pairs(dropped.pair));
  if (joint_cost(rest, costs, problem, dropped.pair) <= other->cost) return dropped;
  Guarded guarded;
  guarded.dropped.assign(pair.size(), unmatched);
  for (std::size_t i = 0; i < pair.size(); ++i) {
    if (pair[i] != unmatched && other->pair[i] == unmatched) guarded.dropped[i] = pair[i];
  }
  guarded.pair = std::move(other->pair);
  guarded.nis = other->joint.nis;
  guarded.dof = other->joint.dof;
  guarded.first_nis = dropped.first_nis;
  guarded.first_dof = dropped.first_dof;
  guarded.alternative = other->alternative;
  return guarded;
}

}  // namespace helixnav::association
