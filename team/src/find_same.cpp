// SPDX-License-Identifier: BSD-3-Clause
#include "find_same.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/observation.hpp"
#include "looks.hpp"
#include "same_places.hpp"
#include "solve.hpp"

namespace helixnav::team {
namespace {

using core::LandmarkId;

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

/// The component with pairs merged, the covariance being left to the solution.
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

/// What the two are taken to be one by: their places, or looks shared out between them.
enum class Evidence { place, turns };

/// χ² of all looks at landmarks, by the noise of one look, and its degrees of freedom: the looks must be of one thing each.
std::pair<double, int> cost_of_looks(std::size_t component, const std::vector<SameLandmarks>& same,
                                     const TeamOptions& options, const State& state) {
  const JointFilter& filter = state.components[component].filter;
  std::map<LandmarkId, Eigen::Vector2d> at_m;
  for (const SameLandmarks& one : same) {
    const auto found = std::find(filter.ids().begin(), filter.ids().end(), one.kept);
    at_m[one.kept] = filter.points_m()[static_cast<std::size_t>(found - filter.ids().begin())];
  }
  double cost = 0.0;
  int dof = 0;
  for (const LandmarkRow& row : state.landmark_rows) {
    const auto place = at_m.find(state.resolve(row.landmark));
    if (place == at_m.end()) continue;
    const core::Pose2& T_component_robot = state.robots[row.robot].clones[row.clone].T_component_robot;
    const core::ObsVector nu = core::innovation(
        row.observation.kind, row.observation.z,
        core::predict_observation(row.observation.kind, T_component_robot, row.T_clone_sensor, place->second).z_hat);
    cost += options.looks_as_one * nu.dot(Eigen::MatrixXd(row.observation.R).inverse() * nu);
    dof += static_cast<int>(nu.size());
  }
  return {cost, dof};
}

bool make_one(std::size_t component, Evidence evidence, std::vector<SameLandmarks> same, const TeamOptions& options,
              State& state) {
  State trial = state;
  const double before = state.components[component].chi2;
  lay_as_one(component, same, trial);
  if (!solve(component, trial)) return false;
  int dof = 2 * static_cast<int>(same.size());
  double cost = std::max(0.0, trial.components[component].chi2 - before);
  if (evidence == Evidence::turns) std::tie(cost, dof) = cost_of_looks(component, same, options, trial);
  const double limit = core::chi2_quantile(options.join.probability, dof);
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

void find_same_by(Evidence evidence, std::size_t component, core::Nanoseconds t_ns, const TeamOptions& options,
                  const RefusedSame& refused, State& state) {
  Places places = mature_places(component, options.join, state);
  const std::vector<LandmarkId> ids = places.ids;
  const std::map<LandmarkId, Looks> looks = looks_of(ids, options.looks_as_one, state);
  const bool by_turns = evidence == Evidence::turns;
  for (const LandmarkId id : ids) {
    if (by_turns) places.split_m2.push_back(looks.at(id).variance_m2);
  }
  places.are_two = [&](std::size_t i, std::size_t j) {
    const Looks &a = looks.at(ids[i]), &b = looks.at(ids[j]);
    const bool may_be_one = by_turns ? were_seen_in_turn(a, b) : !were_seen_together(a, b);
    return !may_be_one || is_refused(ids[i], ids[j], refused, state);
  };
  // One pair by its place alone may be chance; turns say more.
  const double probability = by_turns ? 0.0 : options.join.probability;
  std::vector<SameLandmarks> same;
  for (const SamePlace& pair : same_places(std::move(places), probability)) {
    same.push_back({t_ns, ids[pair.kept], ids[pair.removed], pair.nats, 0.0, 0, 0.0});
  }
  // If least squares objects to all of them, the surest half may still pass.
  while (!same.empty() && !make_one(component, evidence, same, options, state)) same.resize(same.size() / 2);
}

}  // namespace

BirthKey key_of(const Birth& birth) { return {birth.robot, birth.t_ns, birth.observation}; }

void find_same(std::size_t component, core::Nanoseconds t_ns, const TeamOptions& options, const RefusedSame& refused,
               State& state) {
  for (const Evidence evidence : {Evidence::place, Evidence::turns}) {
    if (state.components[component].filter.ids().size() < 2) return;
    find_same_by(evidence, component, t_ns, options, refused, state);
  }
}

}  // namespace helixnav::team
