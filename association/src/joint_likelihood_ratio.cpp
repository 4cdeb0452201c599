// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "costs.hpp"
#include "joint_factor.hpp"
#include "matching.hpp"

namespace helixnav::association {
namespace {

/// The part of a pair's cost other than its likelihood: −ln(P_D/(1−P_D)) and what class and size say.
double detection_cost(const InnovationProblem& problem, const AssignmentProblem& costs, int pair) {
  return costs.cost[pair] + problem.pairs[pair].log_likelihood;
}

/// What a pair costs given the pairs kept in the factor.
double cost_given(JointFactor& factor, const InnovationProblem& problem, const AssignmentProblem& costs, int pair) {
  const Increment increment = factor.weigh(pair);
  return 0.5 * (increment.nis + increment.log_determinant + problem.pairs[pair].dof * ln_2pi) +
         detection_cost(problem, costs, pair);
}

/// Branch and bound for the assignment with the best joint likelihood ratio. The cost of a set is that of the
/// likelihood-ratio assignment with ln N(ν; 0, S) of all its pairs together in place of their sum, so that the errors
/// that observations share (pose, drift) are charged once. Pair by pair it grows by
///   ½Δ + ½ln|D| + ½ d ln 2π − ln(P_D/(1−P_D)),
/// D and Δ being covariance and NIS of the pair given the set. Given anything, D ⪰ R and Δ ≥ 0: that bounds what the
/// observations still to come can save.
class PosteriorSearch {
 public:
  PosteriorSearch(const InnovationProblem& problem, const AssignmentProblem& costs, std::int64_t node_budget)
      : problem_(problem),
        costs_(costs),
        budget_(node_budget),
        order_(observations_by_choice(problem)),
        factor_(problem, order_.size()),
        taken_(problem.ids.size(), 0),
        choices_(order_.size()),
        least_after_(order_.size() + 1, 0.0) {
    for (std::size_t i = order_.size(); i-- > 0;) {
      least_after_[i] = least_after_[i + 1] + std::min(costs.unassigned_cost[order_[i]], least_cost(order_[i]));
    }
  }

  Matching run() {
    descend(0, 0.0);
    return matching_of(problem_, best_, nodes_, nodes_ >= budget_);
  }

 private:
  struct Choice {
    double cost;
    int pair;  // or `unmatched`
  };

  double least_cost(int observation) const {
    const GatedObservation& gated = problem_.observations[observation];
    const GatedPair& pair = problem_.pairs[gated.begin];
    const Eigen::Matrix2d R = pair.S - problem_.predictions[pair.prediction].HPHt;
    const double log_determinant = std::log(R(0, 0) * R(1, 1) - R(0, 1) * R(1, 0));
    // If rounding leaves nothing of R, the bound is lost, not the answer.
    if (std::isnan(log_determinant)) return -infinity;
    double most_nats = pair.appearance_nats;
    for (int p = gated.begin; p < gated.end; ++p) most_nats = std::max(most_nats, problem_.pairs[p].appearance_nats);
    return 0.5 * (log_determinant + gated.dof * ln_2pi) + detection_cost(problem_, costs_, gated.begin) -
           (most_nats - pair.appearance_nats);
  }

  /// Cheapest choice first, so that the first descent is greedy and a spent budget leaves a good answer.
  void weigh_choices(std::size_t depth) {
    const int observation = order_[depth];
    const GatedObservation& gated = problem_.observations[observation];
    std::vector<Choice>& choices = choices_[depth];
    choices.assign(1, {costs_.unassigned_cost[observation], unmatched});
    for (int p = gated.begin; p < gated.end; ++p) {
      if (taken_[problem_.pairs[p].candidate]) continue;
      ++nodes_;
      choices.push_back({cost_given(factor_, problem_, costs_, p), p});
    }
    std::stable_sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) { return a.cost < b.cost; });
  }

  void descend(std::size_t depth, double cost) {
    if (depth == order_.size()) {
      if (cost < best_cost_) {
        best_cost_ = cost;
        best_ = factor_.pairs();
      }
      return;
    }
    weigh_choices(depth);
    for (const Choice& choice : choices_[depth]) {
      // The first descent always ends, whatever the budget.
      if (cost + choice.cost + least_after_[depth + 1] >= best_cost_ ||
          (nodes_ >= budget_ && std::isfinite(best_cost_)))
        return;
      if (choice.pair == unmatched) {
        descend(depth + 1, cost + choice.cost);
        continue;
      }
      char& taken = taken_[problem_.pairs[choice.pair].candidate];
      taken = 1;
      factor_.weigh(choice.pair);  // the last weighed is the one that is kept
      factor_.keep(choice.pair);
      descend(depth + 1, cost + choice.cost);
      factor_.drop();
      taken = 0;
    }
  }

  const InnovationProblem& problem_;
  const AssignmentProblem& costs_;
  std::int64_t budget_;
  std::int64_t nodes_ = 0;
  std::vector<int> order_;
  JointFactor factor_;
  std::vector<char> taken_;
  std::vector<std::vector<Choice>> choices_;
  std::vector<double> least_after_;
  std::vector<int> best_;
  double best_cost_ = infinity;
};

}  // namespace

Matching joint_likelihood_ratio(const InnovationProblem& problem, const AssignmentProblem& costs,
                                std::int64_t node_budget) {
  return PosteriorSearch(problem, costs, node_budget).run();
}

std::vector<double> joint_margins(const InnovationProblem& problem, const AssignmentProblem& costs,
                                  const std::vector<int>& pair) {
  const std::vector<int> matched = matched_pairs(pair);
  JointFactor factor(problem, matched.size());
  std::vector<char> taken(problem.ids.size(), 0);
  for (const int p : matched) taken[problem.pairs[p].candidate] = 1;
  std::vector<double> margins(pair.size(), infinity);
  for (std::size_t i = 0; i < pair.size(); ++i) {
    factor.clear();
    for (const int p : matched) {
      if (p == pair[i]) continue;
      factor.weigh(p);
      factor.keep(p);
    }
    double own = costs.unassigned_cost[i];
    double other = infinity;
    for (int p = problem.observations[i].begin; p < problem.observations[i].end; ++p) {
      if (p != pair[i] && taken[problem.pairs[p].candidate]) continue;
      const double cost = cost_given(factor, problem, costs, p);
      (p == pair[i] ? own : other) = p == pair[i] ? cost : std::min(other, cost);
    }
    if (pair[i] != unmatched) other = std::min(other, costs.unassigned_cost[i]);
    margins[i] = other - own;
  }
  return margins;
}

}  // namespace helixnav::association
