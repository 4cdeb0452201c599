// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>

#include "candidates.hpp"
#include "helixnav/supervisor/join_sessions.hpp"

namespace helixnav::team {
namespace {

using core::LandmarkId;

core::JointMap map_of(std::size_t component, const JoinOptions& options, const State& state) {
  const JointFilter& filter = state.components[component].filter;
  std::vector<std::size_t> order(filter.ids().size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return filter.ids()[a] < filter.ids()[b]; });
  core::JointMap map;
  map.joint.pose = filter.pose(0).mean;
  std::vector<Eigen::Index> rows{0, 1, 2};
  for (const std::size_t i : order) {
    const LandmarkId id = filter.ids()[i];
    const int observations = state.observations[static_cast<std::size_t>(id)];
    map.joint.ids.push_back(id);
    map.joint.points_m.push_back(filter.points_m()[i]);
    map.observations.push_back(observations);
    map.states.push_back(observations >= options.mature_observations ? core::LandmarkState::mature
                                                                     : core::LandmarkState::tentative);
    const auto column = static_cast<Eigen::Index>(3 * filter.robots() + 2 * i);
    rows.insert(rows.end(), {column, column + 1});
  }
  map.joint.covariance = filter.covariance()(rows, rows);
  map.next_name = static_cast<LandmarkId>(state.merged_into.size());
  map.reach_m = state.reach_m;
  return map;
}

}  // namespace

std::optional<Candidate> by_constellation(std::size_t into, std::size_t from, const JoinOptions& options,
                                          const State& state) {
  const supervisor::JoinedSessions joined =
      supervisor::join_sessions({map_of(into, options, state), map_of(from, options, state)});
  const supervisor::JoinedSession& ours = joined.sessions[0];
  const supervisor::JoinedSession& theirs = joined.sessions[1];
  if (ours.component != theirs.component) return std::nullopt;
  Candidate candidate{into, from, TeamJoin::By::constellation, {}, {}, {}, {}};
  candidate.T_into_from.mean = core::compose(core::inverse(ours.T_component_session), theirs.T_component_session);
  for (const auto& [a, name_a] : ours.name_of) {
    for (const auto& [b, name_b] : theirs.name_of) {
      if (name_a == name_b) candidate.same.emplace_back(a, b);
    }
  }
  return candidate;
}

}  // namespace helixnav::team
