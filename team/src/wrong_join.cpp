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

std::optional<WrongJoin> contradiction_of(std::size_t join, const State& state) {
  constexpr int first = 40, least = 6;
  const JoinEvidence& evidence = state.evidence[join];
  WrongJoin count{join, 0, 0};
  for (std::size_t i = evidence.rows_before; i < state.sighting_rows.size() && count.seen < first; ++i) {
    if (!is_between(state.sighting_rows[i], evidence) || state.sighting_rows[i].fits_another) continue;
    ++count.seen;
    count.refused += state.sighting_rows[i].use == SightingRow::Use::refused ? 1 : 0;
    if (count.refused >= least && 2 * count.refused > count.seen) return count;
  }
  return std::nullopt;
}

}  // namespace

std::optional<WrongJoin> find_wrong_join(const State& state) {
  for (std::size_t join = state.joins.size(); join-- > 0;) {
    if (const std::optional<WrongJoin> wrong = contradiction_of(join, state)) return wrong;
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
