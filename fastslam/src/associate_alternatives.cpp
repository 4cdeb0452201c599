// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "associate.hpp"

namespace helixnav::fastslam {

void Associator::associate_sampled(Hypothesis& h, Choice* choices, const double* uniform,
                                   AssociationScratch& scratch) const {
  const std::size_t n = scan_.observations.size();
  std::fill(choices, choices + n, of_nothing);
  for (std::size_t j = 0; j < n; ++j) {
    find_candidates(h, j, options_.new_gate, true, scratch);
    double sum = options_.new_density + options_.clutter_density;
    scratch.share.clear();
    for (const Candidate& c : scratch.candidates) {
      const bool free = !options_.exclusive || !is_taken(choices, c.id);
      scratch.share.push_back(free ? std::exp(c.log_likelihood + log_detection_odds_) : 0.0);
      sum += scratch.share.back();
    }
    double left = uniform[j] * sum;
    std::size_t k = 0;
    while (k < scratch.share.size() && left >= scratch.share[k]) left -= scratch.share[k++];
    // Drawn from its posterior, so that the weight is the normaliser, whatever was drawn.
    const double log_weight = h.log_weight + std::log(sum);
    if (k < scratch.candidates.size()) {
      choices[j] = static_cast<Choice>(scratch.candidates[k].id);
      take(h, scratch.candidates[k], false);
    } else if (left < options_.new_density) {
      choices[j] = begins_landmark;
    }
    h.log_weight = log_weight;
  }
}

void Associator::split(const Hypothesis& h, const Choice* choices, std::size_t observation,
                       AssociationScratch& scratch) const {
  find_candidates(h, observation, options_.match_gate, true, scratch);
  if (!scratch.candidates.empty()) {
    split_in_gate(h, choices, observation, scratch);
    return;
  }
  find_candidates(h, observation, options_.new_gate, true, scratch);
  HypothesisSet& out = scratch.children;
  out.append(h, choices);
  out.all.back().log_weight += log_unmatched_;
  if (scratch.candidates.empty()) out.choices_of(out.size() - 1)[observation] = begins_landmark;
}

void Associator::split_in_gate(const Hypothesis& h, const Choice* choices, std::size_t observation,
                               AssociationScratch& scratch) const {
  HypothesisSet& out = scratch.children;
  const auto child = [&](Choice choice) -> Hypothesis& {
    out.append(h, choices);
    out.choices_of(out.size() - 1)[observation] = choice;
    return out.all.back();
  };
  const std::size_t in_gate = scratch.candidates.size();
  const auto taken = [&](const Candidate& c) { return options_.exclusive && is_taken(choices, c.id); };
  const auto free_end = std::remove_if(scratch.candidates.begin(), scratch.candidates.end(), taken);
  scratch.candidates.erase(free_end, scratch.candidates.end());
  if (options_.hypotheses.split_always || in_gate > 1 || scratch.candidates.empty()) {
    child(begins_landmark).log_weight += log_new_;
    child(of_nothing).log_weight += log_clutter_;
  }
  for (const Candidate& c : scratch.candidates) take(child(static_cast<Choice>(c.id)), c, false);
}

}  // namespace helixnav::fastslam
