// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include "helixnav/association/chi2_table.hpp"
#include "joint_factor.hpp"
#include "matching.hpp"

namespace helixnav::association {
namespace {

/// Joint compatibility branch and bound after Neira and Tardós (2001): of all sets of pairs, each observation and each
/// landmark at most once, whose joint NIS is within the χ² gate of their degrees of freedom, the largest; of the largest
/// the one with the least NIS. NIS only grows with the set, so a set is cut if it exceeds the gate of the most that its
/// branch can still collect, whatever the order of the observations.
class CompatibilitySearch {
 public:
  CompatibilitySearch(const InnovationProblem& problem, double joint_probability, std::int64_t node_budget)
      : problem_(problem),
        budget_(node_budget),
        order_(observations_by_choice(problem)),
        factor_(problem, order_.size()),
        taken_(problem.ids.size(), 0),
        choices_(order_.size()) {
    max_dof_after_.assign(order_.size() + 1, 0);
    for (std::size_t i = order_.size(); i-- > 0;) {
      max_dof_after_[i] = max_dof_after_[i + 1] + problem.observations[order_[i]].dof;
    }
    threshold_.assign(max_dof_after_[0] + 1, 0.0);
    for (int dof = 1; dof <= max_dof_after_[0]; ++dof) threshold_[dof] = chi2_threshold(joint_probability, dof);
  }

  Matching run() {
    descend(0, 0.0, 0);
    return matching_of(problem_, best_, nodes_, nodes_ >= budget_);
  }

 private:
  bool can_still_win(std::size_t depth, double nis) const {
    const std::size_t most = factor_.pairs().size() + (order_.size() - depth);
    return most > best_.size() || (most == best_.size() && nis < best_nis_);
  }

  void keep_if_best(double nis, int dof) {
    const std::vector<int>& pairs = factor_.pairs();
    if (nis > threshold_[dof] || pairs.size() < best_.size()) return;
    if (pairs.size() == best_.size() && nis >= best_nis_) return;
    best_ = pairs;
    best_nis_ = nis;
  }

  struct Choice {
    double nis;  // of the set with it
    int pair;
  };

  /// Pairs of the observation that the gate may still hold, least joint NIS first: the first descent is greedy, and what
  /// it finds cuts the rest.
  void weigh_choices(std::size_t depth, double nis, int dof) {
    const GatedObservation& observation = problem_.observations[order_[depth]];
    std::vector<Choice>& choices = choices_[depth];
    choices.clear();
    for (int p = observation.begin; p < observation.end && nodes_ < budget_; ++p) {
      if (taken_[problem_.pairs[p].candidate]) continue;
      ++nodes_;
      const double next_nis = nis + factor_.weigh(p).nis;
      if (next_nis <= threshold_[dof + max_dof_after_[depth]]) choices.push_back({next_nis, p});
    }
    std::stable_sort(choices.begin(), choices.end(), [](const Choice& a, const Choice& b) { return a.nis < b.nis; });
  }

  void descend(std::size_t depth, double nis, int dof) {
    if (depth == order_.size() || !can_still_win(depth, nis)) return;
    weigh_choices(depth, nis, dof);
    const int next_dof = dof + problem_.observations[order_[depth]].dof;
    for (const Choice& choice : choices_[depth]) {
      if (!can_still_win(depth, choice.nis)) break;
      char& taken = taken_[problem_.pairs[choice.pair].candidate];
      taken = 1;
      factor_.weigh(choice.pair);  // the last weighed is the one that is kept
      factor_.keep(choice.pair);
      keep_if_best(choice.nis, next_dof);
      descend(depth + 1, choice.nis, next_dof);
      factor_.drop();
      taken = 0;
    }
    if (nodes_ < budget_) descend(depth + 1, nis, dof);  // without this observation
  }

  const InnovationProblem& problem_;
  std::int64_t budget_;
  std::int64_t nodes_ = 0;
  std::vector<int> order_;
  JointFactor factor_;
  std::vector<char> taken_;
  std::vector<std::vector<Choice>> choices_;
  std::vector<int> max_dof_after_;
  std::vector<double> threshold_;
  std::vector<int> best_;
  double best_nis_ = std::numeric_limits<double>::infinity();
};

}  // namespace

std::vector<int> observations_by_choice(const InnovationProblem& problem) {
  std::vector<int> order;
  for (std::size_t i = 0; i < problem.observations.size(); ++i) {
    if (problem.observations[i].begin < problem.observations[i].end) order.push_back(static_cast<int>(i));
  }
  const auto choices = [&](int i) { return problem.observations[i].end - problem.observations[i].begin; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return choices(a) < choices(b); });
  return order;
}

Matching matching_of(const InnovationProblem& problem, const std::vector<int>& pairs, std::int64_t nodes,
                     bool budget_hit) {
  Matching matching;
  matching.pair.assign(problem.observations.size(), unmatched);
  for (const int p : pairs) matching.pair[problem.pairs[p].observation] = p;
  matching.nodes = nodes;
  matching.budget_hit = budget_hit;
  return matching;
}

Matching jcbb(const InnovationProblem& problem, double joint_probability, std::int64_t node_budget) {
  return CompatibilitySearch(problem, joint_probability, node_budget).run();
}

}  // namespace helixnav::association
