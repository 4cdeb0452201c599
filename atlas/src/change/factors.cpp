// SPDX-License-Identifier: BSD-3-Clause
// A map that is put away and taken up again, or followed by another drive.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "helixnav/atlas/atlas.hpp"
#include "helixnav/core/errors.hpp"
#include "solve/estimates.hpp"
#include "solve/settle.hpp"
#include "tree/lay_out.hpp"

namespace helixnav::atlas {
namespace {

using core::MapFactors;
using Eigen::Index;

MapFactors::Phase phase_of(const Leaf& leaf) {
  MapFactors::Phase phase;
  phase.revisits = leaf.revisits;
  phase.host = leaf.host;
  phase.T_host_entry = leaf.T_host_entry;
  for (const Part& part : leaf.parts) {
    phase.parts.push_back({part.variables, part.gaussian, {}});
    if (part.fix != nullptr) phase.parts.back().fix = *part.fix;
  }
  return phase;
}

Leaf leaf_of(const MapFactors::Phase& phase) {
  Leaf leaf;
  leaf.revisits = phase.revisits;
  leaf.host = phase.host;
  leaf.T_host_entry = phase.T_host_entry;
  auto factor = std::make_shared<PhaseFactor>();
  if (!phase.parts.empty()) factor->gaussian = *phase.parts.front().gaussian;
  leaf.phase = std::move(factor);
  for (const MapFactors::Part& part : phase.parts) {
    leaf.parts.push_back({part.variables, leaf.parts.empty() ? gaussian_of(leaf.phase) : part.gaussian, nullptr});
    if (part.fix) leaf.parts.back().fix = std::make_shared<const core::AbsoluteFix>(*part.fix);
  }
  return leaf;
}

bool has_dim(int dim, const MapFactors& map, int v) {
  return v >= 0 && v < static_cast<int>(map.variables.size()) && map.variables[State::index(v)].dim == dim;
}

bool is_pose(const MapFactors& map, int v) { return has_dim(3, map, v); }
bool is_point(const MapFactors& map, int v) { return has_dim(2, map, v); }

bool fits(const MapFactors& map, const MapFactors::Part& part) {
  const std::vector<int>& variables = part.variables;
  if (part.gaussian == nullptr || variables.size() < 2) return false;
  if (!is_pose(map, variables[0]) || !is_pose(map, variables[1]) || variables[0] == variables[1]) return false;
  if (!std::all_of(variables.begin() + 2, variables.end(), [&](int v) { return is_point(map, v); })) return false;
  const auto rows = 2 * static_cast<Index>(variables.size()) - 1;
  const RelativeGaussian& g = *part.gaussian;
  return g.information.rows() == rows && g.vector.size() == rows && g.mean.size() == rows &&
         g.information.all_finite() && g.vector.allFinite() && g.mean.allFinite() && std::isfinite(g.chi2);
}

/// A phase joins where it begins with where it ends; one that was taken in has a host that was not.
bool fits(const MapFactors& map, std::size_t k) {
  const MapFactors::Phase& phase = map.phases[k];
  if (phase.parts.empty()) {
    const bool is_taken_in = phase.host >= 0 && phase.host < static_cast<int>(map.phases.size());
    return is_taken_in && map.phases[State::index(phase.host)].host < 0 && phase.revisits < 0;
  }
  const std::vector<int>& ends = phase.parts.front().variables;
  return phase.host < 0 && phase.revisits < static_cast<int>(phase.parts.size()) && phase.revisits != 0 &&
         std::all_of(phase.parts.begin(), phase.parts.end(), [&](const auto& part) { return fits(map, part); }) &&
         ends[0] == map.poses[k] && ends[1] == map.poses[k + 1];
}

bool has_names_in_order(const MapFactors& map) {
  core::LandmarkId last = -1;
  for (const auto& [id, v] : map.landmarks) {
    if (id <= last || !is_point(map, v)) return false;
    last = id;
  }
  return true;
}

/// Of all variables, up to date.
Values all_values(const State& state) {
  Estimates estimates(state);
  if (state.root >= 0) estimates.update_all(state.root);
  Values values;
  for (std::size_t v = 0; v < state.variables.size(); ++v) values.push_back(estimates(static_cast<int>(v)));
  return values;
}

/// Another drive's state behind this one, its variables counted on. The frame of its map is no longer one.
class Behind {
 public:
  Behind(State& state, const State& drive)
      : state_(state),
        drive_(drive),
        variables_(static_cast<int>(state.variables.size())),
        phases_(static_cast<int>(state.phases.size())) {}

  /// `T_atlas_first`: where its first pose is.
  void take_variables(const core::Pose2& T_atlas_first) {
    const Values values = all_values(drive_);
    const core::Pose2 T_drive_first{Eigen::Vector3d(values[State::index(drive_.variable_of_clone[0])])};
    const core::Pose2 T = core::compose(T_atlas_first, core::inverse(T_drive_first));
    for (std::size_t v = 0; v < values.size(); ++v) {
      const Variable& variable = drive_.variables[v];
      Eigen::Vector3d value = values[v];
      if (variable.dim == 3) {
        value = core::compose(T, core::Pose2(value)).vector();
      } else {
        value.head<2>() = core::transform(T, values[v].head<2>());
      }
      const bool is_clone = variable.dim == 3 && variable.name >= 0;
      add_variable(state_, variable.dim, is_clone ? variable.name + phases_ : variable.name, value);
    }
    for (std::size_t k = 0; k < drive_.variable_of_clone.size(); ++k) {
      state_.variable_of_clone.push_back(here(drive_.variable_of_clone[k]));
    }
  }

  void take_names() {
    for (std::size_t id = 0; id < drive_.variable_of_landmark.size(); ++id) {
      if (state_.variable_of_landmark.size() <= id) state_.variable_of_landmark.push_back(-1);
      const int v = drive_.variable_of_landmark[id];
      if (v < 0) continue;
      if (state_.variable_of_landmark[id] >= 0) {
        throw core::PreconditionError("atlas: landmark " + std::to_string(id) + " is in both drives");
      }
      state_.variable_of_landmark.write(id) = here(v);
    }
  }

  void take_phases() {
    for (std::size_t k = 0; k < drive_.phases.size(); ++k) {
      state_.phases.push_back(std::make_shared<const Leaf>(leaf_here(*drive_.phases[k])));
    }
  }

 private:
  int here(int variable) const { return variable + variables_; }

  /// Without what refers to the frame of its map: fixes and the start.
  Leaf leaf_here(const Leaf& leaf) const {
    Leaf moved = leaf;
    moved.parts.clear();
    for (std::size_t i = 0; i < leaf.parts.size(); ++i) {
      const bool is_revisits = static_cast<int>(i) == leaf.revisits;
      if (i > 0 && !is_revisits) continue;
      if (is_revisits) moved.revisits = static_cast<int>(moved.parts.size());
      moved.parts.push_back(leaf.parts[i]);
      for (int& v : moved.parts.back().variables) v = here(v);
    }
    if (leaf.host >= 0) moved.host = leaf.host + phases_;
    return moved;
  }

  State& state_;
  const State& drive_;
  int variables_;
  int phases_;
};

void check_gap(const RelativeGaussian& gap) {
  if (gap.mean.size() == 3 && gap.vector.size() == 3 && gap.mean.allFinite() && gap.vector.allFinite() &&
      gap.information.rows() == 3 && core::is_symmetric_positive_definite(gap.information.full())) {
    return;
  }
  throw core::PreconditionError("atlas: the gap between two drives is no motion with a covariance");
}

/// A phase without landmarks from the last clone to the one that comes next.
Leaf leaf_of_gap(const RelativeGaussian& gap, int entry, int exit) {
  auto factor = std::make_shared<PhaseFactor>();
  factor->gaussian = gap;
  factor->shape.T_entry_robot.emplace_back(Eigen::Vector3d(gap.mean));
  Leaf leaf;
  leaf.phase = std::move(factor);
  leaf.parts.push_back({{entry, exit}, gaussian_of(leaf.phase), nullptr});
  return leaf;
}

}  // namespace

void check_factors(const core::MapFactors& map) {
  const bool is_certain = map.start.covariance.isZero(0.0);
  bool fine = !map.phases.empty() && map.poses.size() == map.phases.size() + 1 && is_pose(map, map.world) &&
              map.start.mean.vector().allFinite() &&
              (is_certain || core::is_symmetric_positive_definite(map.start.covariance)) && has_names_in_order(map);
  for (const MapFactors::Variable& variable : map.variables) {
    fine = fine && (variable.dim == 2 || variable.dim == 3) && variable.value.allFinite();
  }
  for (const int v : map.poses) fine = fine && is_pose(map, v);
  fine = fine && (map.world == map.poses.front()) == is_certain;
  for (std::size_t k = 0; fine && k < map.phases.size(); ++k) fine = fits(map, k);
  if (!fine || map.phases.front().parts.empty()) {
    throw core::PreconditionError("atlas: the factors of the map do not fit together");
  }
}

namespace {

MapFactors factors_of(const State& state, const Values& values) {
  if (state.root < 0) throw core::PreconditionError("atlas: a map without phases has no factors");
  MapFactors map;
  map.start = state.start;
  map.world = state.world;
  for (std::size_t v = 0; v < values.size(); ++v) map.variables.push_back({state.variables[v].dim, values[v]});
  for (std::size_t k = 0; k < state.variable_of_clone.size(); ++k) map.poses.push_back(state.variable_of_clone[k]);
  for (std::size_t id = 0; id < state.variable_of_landmark.size(); ++id) {
    const int v = state.variable_of_landmark[id];
    if (v >= 0 && state.variable(v).name == static_cast<int>(id)) {
      map.landmarks.emplace_back(static_cast<core::LandmarkId>(id), v);
    }
  }
  for (std::size_t k = 0; k < state.phases.size(); ++k) map.phases.push_back(phase_of(*state.phases[k]));
  return map;
}

/// False: it is as it was.
bool settles(Atlas& atlas) {
  try {
    return atlas.settle();
  } catch (const core::NumericalError&) {
    return false;
  }
}

}  // namespace

core::MapFactors Atlas::factors() const { return factors_of(*settled_, all_values(*settled_)); }

core::MapFactors Atlas::unsolved_factors() const {
  const State& state = *working_;
  Values values;
  for (std::size_t v = 0; v < state.values.size(); ++v) values.push_back(state.values[v]);
  MapFactors map = factors_of(state, values);
  map.is_solved = false;
  return map;
}

Atlas Atlas::from_factors(const core::MapFactors& map, const Options& options) {
  check_factors(map);
  Atlas atlas(map.start, options);
  State& state = *atlas.working_;
  state.variables = {};
  state.values = {};
  state.phases_of = {};
  state.variable_of_clone = {};
  state.world = map.world;
  for (const MapFactors::Variable& variable : map.variables) add_variable(state, variable.dim, -1, variable.value);
  for (std::size_t k = 0; k < map.poses.size(); ++k) {
    state.variable_of_clone.push_back(map.poses[k]);
    state.variables.write(State::index(map.poses[k])).name = static_cast<int>(k);
  }
  for (const auto& [id, v] : map.landmarks) {
    while (static_cast<int>(state.variable_of_landmark.size()) <= id) state.variable_of_landmark.push_back(-1);
    state.variable_of_landmark.write(State::index(id)) = v;
    state.variables.write(State::index(v)).name = id;
  }
  for (const MapFactors::Phase& phase : map.phases) {
    state.phases.push_back(std::make_shared<const Leaf>(leaf_of(phase)));
  }
  state.condensed = static_cast<int>(map.phases.size());
  lay_out_anew(state);
  if (!map.is_solved && settles(atlas)) return atlas;
  linearise_in_place(state);
  *atlas.settled_ = state;
  return atlas;
}

Atlas Atlas::followed_by(const RelativeGaussian& gap, const Atlas& drive) const {
  if (!is_settled() || !drive.is_settled() || settled_->root < 0) {
    throw core::PreconditionError("atlas: only a settled drive can be followed by another one");
  }
  check_gap(gap);
  const State& next = *drive.settled_;
  Atlas both(*this);
  State& state = *both.working_;
  const Values values = all_values(state);
  for (std::size_t v = 0; v < values.size(); ++v) state.values.write(v) = values[v];
  const int last = state.variable_of_clone.back();
  const int first = static_cast<int>(state.variables.size()) + next.variable_of_clone[0];
  const core::Pose2 T_last_first{Eigen::Vector3d(gap.mean)};
  const core::Pose2 T_atlas_first = core::compose(core::Pose2(Eigen::Vector3d(state.value(last))), T_last_first);
  state.phases.push_back(std::make_shared<const Leaf>(leaf_of_gap(gap, last, first)));
  Behind behind(state, next);
  behind.take_variables(T_atlas_first);
  behind.take_names();
  behind.take_phases();
  lay_out_anew(state);
  linearise_in_place(state);
  *both.settled_ = state;
  return both;
}

}  // namespace helixnav::atlas
