// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/association/associate.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "helixnav/association/linear_assignment.hpp"
#include "helixnav/core/errors.hpp"
#include "matching.hpp"

namespace helixnav::association {
namespace {

void check(const Options& options) {
  const auto require = [](bool ok, const char* what) {
    if (!ok) throw core::PreconditionError(std::string("association options: ") + what);
  };
  require(options.joint_probability > 0.0 && options.joint_probability < 1.0, "joint_probability must lie in (0, 1)");
  require(options.min_margin_nats >= 0.0, "min_margin_nats must not be negative");
  require(options.joint_alternatives >= 0, "joint_alternatives must not be negative");
  require(options.node_budget >= 1, "node_budget must be at least 1");
}

bool is_whole_scan(Method method) {
  return method == Method::likelihood_ratio || method == Method::ihgr_likelihood_ratio;
}

/// Cheapest other choice that the other observations leave to each, "none" included, minus the cost of its choice.
std::vector<double> margins_by_observation(const AssignmentProblem& costs, const std::vector<int>& pair) {
  std::vector<double> margins(pair.size());
  std::vector<int> holders(costs.columns, 0);
  for (const int e : matched_pairs(pair)) ++holders[costs.column[e]];
  for (int i = 0; i < costs.rows(); ++i) {
    double other = std::numeric_limits<double>::infinity();
    if (pair[i] != unmatched) other = costs.unassigned_cost[i];
    for (int e = costs.row_begin[i]; e < costs.row_begin[i + 1]; ++e) {
      if (e != pair[i] && holders[costs.column[e]] == 0) other = std::min(other, costs.cost[e]);
    }
    margins[i] = other - (pair[i] == unmatched ? costs.unassigned_cost[i] : costs.cost[pair[i]]);
  }
  return margins;
}

struct Proposal {
  Matching matching;
  std::vector<double> margins;
};

Proposal propose(Method method, const InnovationProblem& problem, const AssignmentProblem& costs,
                 const Options& options) {
  Proposal proposal;
  switch (method) {
    case Method::nearest_neighbour:
      proposal.matching = nearest_neighbour(problem);
      break;
    case Method::nearest_neighbour_unique:
      proposal.matching = nearest_neighbour_unique(problem);
      break;
    case Method::jcbb:
      proposal.matching = jcbb(problem, options.joint_probability, options.node_budget);
      break;
    case Method::joint_likelihood_ratio:
      proposal.matching = joint_likelihood_ratio(problem, costs, options.node_budget);
      proposal.margins = joint_margins(problem, costs, proposal.matching.pair);
      return proposal;
    case Method::ihgr_published:
      proposal.matching = ihgr_published(problem, options.node_budget);
      break;
    case Method::ihgr_likelihood_ratio:
      proposal.matching = ihgr_likelihood_ratio(costs, options.node_budget);
      proposal.margins = assignment_margins(costs, solve_assignment(costs));
      return proposal;
    case Method::likelihood_ratio: {
      AssignmentSolution solution = solve_assignment(costs);
      proposal.margins = assignment_margins(costs, solution);
      proposal.matching.pair = std::move(solution.entry);
      return proposal;
    }
  }
  proposal.margins = margins_by_observation(costs, proposal.matching.pair);
  return proposal;
}

ObservationOutcome outcome_of(const InnovationProblem& problem, int observation, int pair, int dropped, double margin) {
  const GatedObservation& gated = problem.observations[observation];
  ObservationOutcome outcome;
  outcome.margin_nats = margin;
  outcome.dropped_by_joint_test = dropped != unmatched;
  const int named = pair != unmatched ? pair : dropped;
  if (named != unmatched) {
    outcome.outcome = pair != unmatched ? Outcome::matched : Outcome::ambiguous;
    outcome.pair = named;
    outcome.candidate = problem.pairs[named].candidate;
    outcome.landmark = problem.ids[outcome.candidate];
    outcome.nis = problem.pairs[named].nis;
    outcome.dof = gated.dof;
  } else if (std::isinf(gated.nearest_nis)) {
    outcome.outcome = Outcome::new_landmark;
  } else {
    outcome.candidate = gated.nearest_candidate;
    outcome.landmark = problem.ids[outcome.candidate];
    outcome.nis = gated.nearest_nis;
    outcome.dof = gated.dof;
  }
  return outcome;
}

}  // namespace

std::string_view name(Method method) {
  switch (method) {
    case Method::nearest_neighbour:
      return "nearest-neighbour";
    case Method::nearest_neighbour_unique:
      return "nearest-neighbour-unique";
    case Method::likelihood_ratio:
      return "likelihood-ratio";
    case Method::jcbb:
      return "jcbb";
    case Method::joint_likelihood_ratio:
      return "joint-likelihood-ratio";
    case Method::ihgr_published:
      return "ihgr-published";
    default:
      return "ihgr-likelihood-ratio";
  }
}

Assignment associate(Method method, const InnovationProblem& problem, const Options& options) {
  check(options);
  const AssignmentProblem costs = likelihood_ratio_costs(problem, options.detection_probability, options.extraneous);
  Proposal proposal = propose(method, problem, costs, options);
  std::vector<int>& pair = proposal.matching.pair;
  if (options.min_margin_nats > 0.0) {  // at 0 even the methods that judge by other costs keep their choice
    for (std::size_t i = 0; i < pair.size(); ++i) {
      if (proposal.margins[i] < options.min_margin_nats) pair[i] = unmatched;
    }
  }
  Guarded guarded = is_whole_scan(method) ? guard_by_alternatives(problem, costs, pair, options)
                                          : guard_by_dropping(problem, pair, options);

  Assignment assignment;
  assignment.observations.reserve(pair.size());
  for (std::size_t i = 0; i < pair.size(); ++i) {
    assignment.observations.push_back(
        outcome_of(problem, static_cast<int>(i), guarded.pair[i], guarded.dropped[i], proposal.margins[i]));
    assignment.dropped_pairs += guarded.dropped[i] != unmatched;
  }
  assignment.pairs = matched_pairs(guarded.pair);
  assignment.joint_nis = guarded.nis;
  assignment.joint_dof = guarded.dof;
  assignment.first_joint_nis = guarded.first_nis;
  assignment.first_joint_dof = guarded.first_dof;
  assignment.alternative = guarded.alternative;
  assignment.nodes = proposal.matching.nodes;
  assignment.budget_hit = proposal.matching.budget_hit;
  assignment.roundings = proposal.matching.roundings;
  return assignment;
}

}  // namespace helixnav::association
