// SPDX-License-Identifier: BSD-3-Clause
#include "find_same.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/chi2.hpp"
#include "same_places.hpp"
#include "solve.hpp"

namespace helixnav::team {
namespace {

using core::LandmarkId;

/// The scans that saw a landmark, in order.
using Looks = std::vector<std::pair<std::size_t, std::int64_t>>;

std::map<LandmarkId, Looks> looks_of(const std::vector<LandmarkId>& ids, const State& state) {
  std::map<LandmarkId, Looks> looks;
  for (const LandmarkId id : ids) looks[id];
  for (const LandmarkRow& row : state.landmark_rows) {
    const auto of_id = looks.find(state.resolve(row.landmark));
    if (of_id != looks.end()) of_id->second.emplace_back(row.robot, row.scan);
  }
  for (auto& [id, one] : looks) std::sort(one.begin(), one.end());
  return looks;
}

/// Things of which one scan shows both are two. A look in twenty may have been taken for the other's.
bool were_seen_together(const Looks& a, const Looks& b) {
  constexpr double most_mistaken = 0.05;
  std::size_t together = 0;
  for (auto i = a.begin(), k = b.begin(); i != a.end() && k != b.end();) {
    if (*i == *k) {
      ++together;
      ++i;
      ++k;
    } else {
      ++(*i < *k ? i : k);
    }
  }
  return static_cast<double>(together) > most_mistaken * static_cast<double>(std::min(a.size(), b.size()));
}

/// Other landmarks within reach of each, one at least, over the area within reach.
std::vector<double> densities(const std::vector<Eigen::Vector2d>& at_m, double reach_m) {
  std::vector<double> density_per_m2;
  for (const Eigen::Vector2d& place_m : at_m) {
    const auto near = std::count_if(at_m.begin(), at_m.end(), [&](const Eigen::Vector2d& other_m) {
      return (other_m - place_m).norm() <= reach_m;
    });
    density_per_m2.push_back(static_cast<double>(std::max<std::ptrdiff_t>(near - 1, 1)) /
                             (core::pi * reach_m * reach_m));
  }
  return density_per_m2;
}

/// Landmarks seen often enough; without what is known of pairs.
Places mature_places(std::size_t component, const JoinOptions& options, const State& state) {
  const JointFilter& filter = state.components[component].filter;
  Places places;
  std::vector<Eigen::Index> columns;
  for (std::size_t i = 0; i < filter.ids().size(); ++i) {
    const LandmarkId id = filter.ids()[i];
    if (state.observations[static_cast<std::size_t>(id)] < options.mature_observations) continue;
    places.ids.push_back(id);
    places.at_m.push_back(filter.points_m()[i]);
    const auto column = static_cast<Eigen::Index>(3 * filter.robots() + 2 * i);
    columns.insert(columns.end(), {column, column + 1});
  }
  places.covariance = filter.covariance()(columns, columns);
  places.density_per_m2 = densities(places.at_m, state.reach_m);
  return places;
}

bool is_refused(LandmarkId a, LandmarkId b, const RefusedSame& refused, const State& state) {
  const BirthKey key_a = key_of(state.births[static_cast<std::size_t>(a)]);
  const BirthKey key_b = key_of(state.births[static_cast<std::size_t>(b)]);
  return refused.count({std::min(key_a, key_b), std::max(key_a, key_b)}) > 0;
}

/// The component with pairs as one, the covariance being for the solution to find.
void lay_as_one(std::size_t component, const std::vector<SameLandmarks>& same, State& state) {
  std::vector<LandmarkId> removed;
  for (const SameLandmarks& one : same) {
    state.merged_into[static_cast<std::size_t>(one.removed)] = one.kept;
    state.observations[static_cast<std::size_t>(one.kept)] += state.observations[static_cast<std::size_t>(one.removed)];
    state.merged.push_back({one.kept, one.removed});
    removed.push_back(one.removed);
  }
  state.components[component].filter.remove(removed);
}

bool make_one(std::size_t component, std::vector<SameLandmarks> same, const TeamOptions& options, State& state) {
  State trial = state;
  const double before = state.components[component].chi2;
  lay_as_one(component, same, trial);
  if (!solve(component, trial)) return false;
  const int dof = 2 * static_cast<int>(same.size());
  const double limit = core::chi2_quantile(options.join.probability, dof);
  const double cost = std::max(0.0, trial.components[component].chi2 - before);
  if (!(cost <= limit)) return false;
  for (SameLandmarks& one : same) {
    one.cost = cost;
    one.dof = dof;
    one.limit = limit;
    trial.same.push_back(one);
  }
  state = std::move(trial);
  return true;
}

}  // namespace

BirthKey key_of(const Birth& birth) { return {birth.robot, birth.t_ns, birth.observation}; }

void find_same(std::size_t component, core::Nanoseconds t_ns, const TeamOptions& options, const RefusedSame& refused,
               State& state) {
  if (state.components[component].filter.ids().size() < 2) return;
  Places places = mature_places(component, options.join, state);
  const std::vector<LandmarkId> ids = places.ids;
  const std::map<LandmarkId, Looks> looks = looks_of(ids, state);
  places.are_two = [&](std::size_t i, std::size_t j) {
    return were_seen_together(looks.at(ids[i]), looks.at(ids[j])) || is_refused(ids[i], ids[j], refused, state);
  };
  std::vector<SameLandmarks> same;
  for (const SamePlace& pair : same_places(std::move(places), options.join.probability)) {
    same.push_back({t_ns, ids[pair.kept], ids[pair.removed], pair.nats, 0.0, 0, 0.0});
  }
  // Where least squares objects to all of them, the surest half may still pass.
  while (!same.empty() && !make_one(component, same, options, state)) same.resize(same.size() / 2);
}

}  // namespace helixnav::team
