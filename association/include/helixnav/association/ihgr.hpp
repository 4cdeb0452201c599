// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "helixnav/association/innovation_problem.hpp"
#include "helixnav/association/linear_assignment.hpp"

namespace helixnav::association {

/// The validation gate of ihgr_zhang2005 §III.A: νᵀs⁻¹ν ≤ 6.63, which they take to be the 99 % quantile. It is that for
/// one degree of freedom; for range and bearing together it passes 96.4 % of the correct pairs.
inline constexpr double ihgr_published_gate = 6.63;

/// The cost of ihgr_zhang2005 eq (5), (9): −ln Λ = ½νᵀs⁻¹ν + ½ln|2πs| for a pair (eq (5) lacks the minus sign in its
/// exponent), 0 for a dummy. A density is compared with the pure number 1: the decision depends on the units of z.
/// Pairs beyond the published gate are left out; pair_of_entry maps back.
struct PublishedProblem {
  AssignmentProblem assignment;
  std::vector<int> pair_of_entry;
};
PublishedProblem ihgr_published_costs(const InnovationProblem& problem);

/// Optimal vertex x of the linear relaxation, ihgr_zhang2005 eq (6)-(8) with 0 ≤ x ≤ 1, by CLP's primal simplex. One
/// value for each entry of the problem; the remainder to 1 in a row or a column is its dummy. The constraint matrix is
/// totally unimodular, so a vertex is integral and optimal for the integer problem. Throws NumericalError when CLP does
/// not end at an optimum. Test: association/ihgr_test.cpp.
std::vector<double> relaxed_assignment(const AssignmentProblem& problem);

struct RoundedAssignment {
  std::vector<int> entry;  ///< for each row the entry, or −1 for the dummy
  double cost = 0.0;
  int roundings = 0;  ///< fractional variables set to 1, singly or by the tie rule; 0 for an integral x
  std::int64_t combinations = 0;
  bool budget_hit = false;  ///< the tie rule saw only the first `budget` combinations
};

/// Iterative heuristic greedy rounding, ihgr_zhang2005 §III.B. Variables at 1 are kept and whatever they determine is
/// removed; then the largest fractional variable is set to 1 if it stands out (> 0.5; only one in each row and column
/// can), the linear programme of the rest is solved again, and so on; if none stands out, all combinations of the
/// fractional variables are evaluated and the cheapest is taken. Always ends with a feasible assignment.
/// Throws PreconditionError unless x fits the problem and is feasible to 1e-6.
/// Test: association/ihgr_test.cpp (an interior optimal solution of a tie; a forced start).
RoundedAssignment round_greedily(const AssignmentProblem& problem, std::vector<double> x,
                                 std::int64_t combination_budget);

}  // namespace helixnav::association
