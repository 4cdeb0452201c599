// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>

#include "matching.hpp"

namespace helixnav::association {

Matching nearest_neighbour(const InnovationProblem& problem) {
  Matching matching;
  matching.pair.reserve(problem.observations.size());
  // Pairs of an observation are in order of their NIS.
  for (const GatedObservation& o : problem.observations) matching.pair.push_back(o.begin < o.end ? o.begin : unmatched);
  return matching;
}

Matching nearest_neighbour_unique(const InnovationProblem& problem) {
  std::vector<int> order(problem.pairs.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return problem.pairs[a].nis < problem.pairs[b].nis; });
  Matching matching;
  matching.pair.assign(problem.observations.size(), unmatched);
  std::vector<char> taken(problem.ids.size(), 0);
  for (const int p : order) {
    const GatedPair& pair = problem.pairs[p];
    if (taken[pair.candidate] || matching.pair[pair.observation] != unmatched) continue;
    taken[pair.candidate] = 1;
    matching.pair[pair.observation] = p;
  }
  return matching;
}

}  // namespace helixnav::association
