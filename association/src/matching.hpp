// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "helixnav/association/associate.hpp"
#include "helixnav/association/innovation_problem.hpp"

namespace helixnav::association {

inline constexpr int unmatched = -1;

/// What a method proposes, before the joint test and the outcomes.
struct Matching {
  std::vector<int> pair;  ///< for each observation an index into InnovationProblem::pairs, or `unmatched`
  std::int64_t nodes = 0;
  bool budget_hit = false;
  int roundings = 0;
};

Matching nearest_neighbour(const InnovationProblem& problem);
Matching nearest_neighbour_unique(const InnovationProblem& problem);
Matching jcbb(const InnovationProblem& problem, double joint_probability, std::int64_t node_budget);
Matching ihgr_published(const InnovationProblem& problem, std::int64_t combination_budget);
Matching ihgr_likelihood_ratio(const AssignmentProblem& costs, std::int64_t combination_budget);

Matching joint_likelihood_ratio(const InnovationProblem& problem, const AssignmentProblem& costs,
                                std::int64_t node_budget);

/// For each observation the joint cost of its best other choice, all others staying, minus that of its choice.
std::vector<double> joint_margins(const InnovationProblem& problem, const AssignmentProblem& costs,
                                  const std::vector<int>& pair);

/// Observations with a pair, those with the fewest first: a search tree is narrow where it is cut most.
std::vector<int> observations_by_choice(const InnovationProblem& problem);

Matching matching_of(const InnovationProblem& problem, const std::vector<int>& pairs, std::int64_t nodes,
                     bool budget_hit);

/// Indices of the matched pairs, by observation.
std::vector<int> matched_pairs(const std::vector<int>& pair_of_observation);

/// A matching that has been put to the joint χ² test.
struct Guarded {
  std::vector<int> pair;     ///< as Matching::pair
  std::vector<int> dropped;  ///< for each observation the pair it lost, or `unmatched`
  double nis = 0.0;
  int dof = 0;
  double first_nis = 0.0;
  int first_dof = 0;
  int alternative = 0;
};

/// Drops the pair whose absence lowers the joint NIS most, until the rest passes.
Guarded guard_by_dropping(const InnovationProblem& problem, const std::vector<int>& pair, const Options& options);

/// The same, but when the test fails the next best assignments compete with the dropping: of those that pass, the one
/// with the best joint likelihood ratio is taken.
Guarded guard_by_alternatives(const InnovationProblem& problem, const AssignmentProblem& costs,
                              const std::vector<int>& pair, const Options& options);

}  // namespace helixnav::association
