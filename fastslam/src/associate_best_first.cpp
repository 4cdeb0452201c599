// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "associate.hpp"

namespace helixnav::fastslam {

/// All pairs in the gate with the key they are taken by; nearest_nis: of each observation to any landmark.
void Associator::find_pairs(const Hypothesis& h, AssociationScratch& scratch) const {
  const std::size_t n = scan_.observations.size();
  const bool by_likelihood = options_.association == Association::likelihood_ratio;
  scratch.pairs.clear();
  scratch.nearest_nis.assign(n, HUGE_VAL);
  for (std::size_t j = 0; j < n; ++j) {
    find_candidates(h, j, std::max(options_.match_gate, options_.new_gate), by_likelihood, scratch);
    for (const Candidate& c : scratch.candidates) {
      scratch.nearest_nis[j] = std::min(scratch.nearest_nis[j], c.nis);
      if (c.nis <= options_.match_gate) scratch.pairs.push_back(c);
    }
  }
  const auto before = [&](const Candidate& a, const Candidate& b) {
    const double key_a = by_likelihood ? -a.log_likelihood : a.nis, key_b = by_likelihood ? -b.log_likelihood : b.nis;
    if (key_a != key_b) return key_a < key_b;
    return a.observation != b.observation ? a.observation < b.observation : a.id < b.id;
  };
  std::sort(scratch.pairs.begin(), scratch.pairs.end(), before);
}

/// Every landmark in the gate of the observation went to another one: so this is another object.
bool Associator::has_no_landmark_left(std::size_t observation, const Choice* choices,
                                      const AssociationScratch& scratch) const {
  bool any = false;
  for (const Candidate& c : scratch.pairs) {
    if (c.observation != observation) continue;
    if (!is_taken(choices, c.id)) return false;
    any = true;
  }
  return any;
}

void Associator::associate_best_first(Hypothesis& h, Choice* choices, AssociationScratch& scratch) const {
  const std::size_t n = scan_.observations.size();
  std::fill(choices, choices + n, of_nothing);
  find_pairs(h, scratch);
  const double least =
      options_.association == Association::likelihood_ratio ? log_unmatched_ - log_detection_odds_ : -HUGE_VAL;
  for (const Candidate& c : scratch.pairs) {
    if (c.log_likelihood < least) break;
    if (choices[c.observation] >= 0 || (options_.exclusive && is_taken(choices, c.id))) continue;
    choices[c.observation] = static_cast<Choice>(c.id);
    take(h, c, false);
  }
  for (std::size_t j = 0; j < n; ++j) {
    if (choices[j] >= 0) continue;
    h.log_weight += log_unmatched_;
    const bool is_new =
        scratch.nearest_nis[j] > options_.new_gate || (options_.exclusive && has_no_landmark_left(j, choices, scratch));
    if (is_new) choices[j] = begins_landmark;
  }
}

}  // namespace helixnav::fastslam
