// SPDX-License-Identifier: BSD-3-Clause
#include <map>

#include "candidates.hpp"
#include "common_names.hpp"

namespace helixnav::team {
namespace {

using core::LandmarkId;

std::map<std::int64_t, LandmarkId> mature_names(std::size_t component, const JoinOptions& options, const State& state) {
  std::map<std::int64_t, LandmarkId> names;
  for (const auto& [key, id] : state.id_of_name) {
    if (state.robots[key.first].component != component) continue;
    const LandmarkId now = state.resolve(id);
    if (state.observations[static_cast<std::size_t>(now)] >= options.mature_observations) names[key.second] = now;
  }
  return names;
}

}  // namespace

std::optional<Candidate> by_names(std::size_t into, std::size_t from, const JoinOptions& options, const State& state) {
  const std::map<std::int64_t, LandmarkId> ours = mature_names(into, options, state);
  const std::map<std::int64_t, LandmarkId> theirs = mature_names(from, options, state);
  SamePairs pairs;
  for (const auto& [name, id] : ours) {
    const auto same = theirs.find(name);
    if (same != theirs.end()) pairs.emplace_back(id, same->second);
  }
  if (pairs.size() < 2) return std::nullopt;
  NamesFit fit = fit_names(into, from, pairs, options, state);
  if (!fit.agree) return std::nullopt;
  Candidate candidate{into, from, TeamJoin::By::names, fit.T_into_from, {}, {}, {}};
  candidate.same = std::move(fit.kept);
  candidate.left_out = std::move(fit.left_out);
  return candidate;
}

}  // namespace helixnav::team
