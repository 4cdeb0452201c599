// SPDX-License-Identifier: BSD-3-Clause
#include "looks.hpp"

#include <algorithm>
#include <iterator>

#include "solve.hpp"

namespace helixnav::team {

std::map<core::LandmarkId, Looks> looks_of(const std::vector<core::LandmarkId>& ids, double looks_as_one,
                                           const State& state) {
  std::map<core::LandmarkId, Looks> looks;
  for (const core::LandmarkId id : ids) looks[id];
  for (const LandmarkRow& row : state.landmark_rows) {
    const auto of_id = looks.find(state.resolve(row.landmark));
    if (of_id == looks.end()) continue;
    of_id->second.scans.emplace_back(row.robot, row.scan);
    if (core::dimension(row.observation.kind) != 2) continue;
    of_id->second.variance_m2 +=
        0.5 * seen_position(row.T_clone_sensor, row.observation).covariance_m2.trace() / looks_as_one;
  }
  for (auto& [id, one] : looks) {
    std::sort(one.scans.begin(), one.scans.end());
    one.variance_m2 /= std::max(1.0, static_cast<double>(one.scans.size()));
  }
  return looks;
}

bool were_seen_together(const Looks& a, const Looks& b) {
  constexpr double most_mistaken = 0.05;
  std::vector<std::pair<std::size_t, std::int64_t>> together;
  std::set_intersection(a.scans.begin(), a.scans.end(), b.scans.begin(), b.scans.end(), std::back_inserter(together));
  const std::size_t fewer = std::min(a.scans.size(), b.scans.size());
  return static_cast<double>(together.size()) > most_mistaken * static_cast<double>(fewer);
}

bool were_seen_in_turn(const Looks& a, const Looks& b) {
  constexpr int least_turns = 4;
  constexpr std::int64_t most_apart = 3;  // scans: it stands in view meanwhile
  int turns = 0;
  auto i = a.scans.begin(), k = b.scans.begin();
  const std::pair<std::size_t, std::int64_t>* last = nullptr;
  bool last_was_a = false;
  while (i != a.scans.end() || k != b.scans.end()) {
    const bool is_a = k == b.scans.end() || (i != a.scans.end() && *i < *k);
    const auto& now = is_a ? *i++ : *k++;
    const bool is_near = last != nullptr && last->first == now.first && now.second - last->second <= most_apart;
    turns += is_near && is_a != last_was_a && now.second != last->second ? 1 : 0;
    last = &now;
    last_was_a = is_a;
  }
  return turns >= least_turns && !were_seen_together(a, b);
}

}  // namespace helixnav::team
