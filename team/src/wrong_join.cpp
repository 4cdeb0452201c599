// SPDX-License-Identifier: BSD-3-Clause
#include "wrong_join.hpp"

#include <algorithm>

namespace helixnav::team {
namespace {

bool has(const std::vector<std::size_t>& robots, std::size_t robot) {
  return std::find(robots.begin(), robots.end(), robot) != robots.end();
}

bool is_between(const SightingRow& row, const JoinEvidence& join) {
  return (has(join.into, row.robot) && has(join.from, row.seen)) ||
         (has(join.from, row.robot) && has(join.into, row.seen));
}

bool is_contradicted(const JoinEvidence& join, const State& state) {
  constexpr int first = 40, least = 6;
  int seen = 0, refused = 0;
  for (std::size_t i = join.rows_before; i < state.sighting_rows.size() && seen < first; ++i) {
    if (!is_between(state.sighting_rows[i], join)) continue;
    ++seen;
    refused += state.sighting_rows[i].use == SightingRow::Use::refused ? 1 : 0;
    if (refused >= least && 2 * refused > seen) return true;
  }
  return false;
}

}  // namespace

std::optional<std::size_t> find_wrong_join(const State& state) {
  for (std::size_t join = state.joins.size(); join-- > 0;) {
    if (is_contradicted(state.evidence[join], state)) return join;
  }
  return std::nullopt;
}

void refuse(std::size_t join, const State& state, RefusedJoins& refused) {
  const TeamJoin& wrong = state.joins[join];
  if (wrong.by != TeamJoin::By::sightings) {
    refused.joins.insert({wrong.by, wrong.robot, wrong.other});
    return;
  }
  for (const std::size_t row : state.evidence[join].sightings) {
    refused.sightings.insert(key_of(state.sighting_rows[row]));
  }
}

}  // namespace helixnav::team
