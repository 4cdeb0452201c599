// SPDX-License-Identifier: BSD-3-Clause
#include "join_components.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include <Eigen/LU>

#include "common_names.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "process.hpp"
#include "solve.hpp"

namespace helixnav::team {
namespace {

using Use = SightingRow::Use;

/// All that both call by the same name.
void add_common_names(Candidate& candidate, const State& state) {
  std::map<std::int64_t, core::LandmarkId> ours;
  for (const auto& [key, id] : state.id_of_name) {
    if (state.robots[key.first].component == candidate.into) ours[key.second] = state.resolve(id);
  }
  std::set<core::LandmarkId> done;
  for (const auto& pair : candidate.same) done.insert(pair.second);
  for (const auto& pair : candidate.left_out) done.insert(pair.second);
  for (const auto& [key, id] : state.id_of_name) {
    if (state.robots[key.first].component != candidate.from) continue;
    const auto same = ours.find(key.second);
    if (same == ours.end() || !done.insert(state.resolve(id)).second) continue;
    candidate.same.emplace_back(same->second, state.resolve(id));
  }
}

/// Both in one frame and in one list, with what ties them; the covariance is left to the solution.
void lay_together(const Candidate& candidate, State& state) {
  Component& into = state.components[candidate.into];
  Component& from = state.components[candidate.from];
  const core::Pose2& T = candidate.T_into_from.mean;
  for (const auto& [kept, removed] : candidate.same) {
    state.merged_into[static_cast<std::size_t>(removed)] = kept;
    state.observations[static_cast<std::size_t>(kept)] += state.observations[static_cast<std::size_t>(removed)];
    state.merged.push_back({kept, removed});
  }
  std::vector<core::Pose2> poses;
  for (std::size_t slot = 0; slot < into.robots.size(); ++slot) poses.push_back(into.filter.pose(slot).mean);
  for (const std::size_t r : from.robots) {
    poses.push_back(core::compose(T, from.filter.pose(state.robots[r].slot).mean));
    state.robots[r].component = candidate.into;
    state.robots[r].slot = into.robots.size();
    into.robots.push_back(r);
    for (Clone& clone : state.robots[r].clones) clone.T_component_robot = core::compose(T, clone.T_component_robot);
  }
  std::vector<core::LandmarkId> ids = into.filter.ids();
  std::vector<Eigen::Vector2d> points_m = into.filter.points_m();
  for (std::size_t i = 0; i < from.filter.ids().size(); ++i) {
    const core::LandmarkId id = from.filter.ids()[i];
    if (state.resolve(id) != id) continue;
    ids.push_back(id);
    points_m.push_back(core::transform(T, from.filter.points_m()[i]));
  }
  from = Component();
  const auto columns = static_cast<Eigen::Index>(3 * poses.size() + 2 * ids.size());
  into.filter = JointFilter(poses, ids, points_m, Eigen::MatrixXd::Zero(columns, columns));
}

struct Explained {
  int used = 0;
  int refused = 0;
};

/// Sightings that were between the two: those that the solution explains become rows of it.
Explained use_sightings(std::size_t component, double gate_probability, State& state) {
  Explained explained;
  for (SightingRow& row : state.sighting_rows) {
    const bool inside = state.robots[row.robot].component == component && state.robots[row.seen].component == component;
    if (!inside || row.use != Use::apart) continue;
    const core::Pose2& from = state.robots[row.robot].clones[row.clone].T_component_robot;
    const core::Pose2& to = state.robots[row.seen].clones[row.seen_clone].T_component_robot;
    const core::PredictedObservation predicted =
        core::predict_observation(row.observation.kind, from, row.T_robot_sensor, to.position_m());
    const core::ObsVector nu = core::innovation(row.observation.kind, row.observation.z, predicted.z_hat);
    row.nis = nu.dot(row.observation.R.inverse() * nu);
    const bool fits = row.nis <= core::chi2_quantile(gate_probability, static_cast<int>(nu.size()));
    row.use = fits ? Use::used : Use::refused;
    ++(fits ? explained.used : explained.refused);
  }
  return explained;
}

/// χ² of the joint solution over that of both apart, with the rows that tie them.
bool passes(double apart_chi2, int rows, const State& state, const TeamOptions& options, TeamJoin& join) {
  join.dof = rows - 3;
  if (join.dof < 1) return false;
  join.cost =
      std::max(0.0, state.components[state.robots[static_cast<std::size_t>(join.robot)].component].chi2 - apart_chi2);
  join.limit = core::chi2_quantile(options.join.probability, join.dof);
  return join.cost <= join.limit;
}

/// Whether both first robots are known well enough, each seen from the other: two names say little about a heading.
bool is_placed(const TeamJoin& join, const State& state, const JoinOptions& options) {
  const Robot& a = state.robots[static_cast<std::size_t>(join.robot)];
  const Robot& b = state.robots[static_cast<std::size_t>(join.other)];
  const JointFilter& filter = state.components[a.component].filter;
  const core::Pose2 T_world_a = filter.pose(a.slot).mean;
  const core::Pose2 T_a_b = core::between(T_world_a, filter.pose(b.slot).mean);
  const Eigen::Matrix2d R = core::rotation(T_world_a.heading_rad).transpose();
  Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
  J.topLeftCorner<2, 2>() = -R;
  J.col(2) << T_a_b.y_m, -T_a_b.x_m, -1.0;
  J.block<2, 2>(0, 3) = R;
  J(2, 5) = 1.0;
  const auto at = [](const Robot& robot) { return static_cast<Eigen::Index>(3 * robot.slot); };
  Eigen::Matrix<double, 6, 6> P;
  P << filter.covariance().block<3, 3>(at(a), at(a)), filter.covariance().block<3, 3>(at(a), at(b)),
      filter.covariance().block<3, 3>(at(b), at(a)), filter.covariance().block<3, 3>(at(b), at(b));
  const Eigen::Matrix3d relative = J * P * J.transpose();
  return std::sqrt(relative.topLeftCorner<2, 2>().trace()) <= options.max_sigma_m &&
         std::sqrt(relative(2, 2)) <= options.max_sigma_rad;
}

/// Of two landmarks of one name, the one that was seen much less often was begun by a misread name.
void forget_misread(const Candidate& candidate, State& state) {
  for (const auto& [ours, theirs] : candidate.left_out) {
    const int a = state.observations[static_cast<std::size_t>(ours)];
    const int b = state.observations[static_cast<std::size_t>(theirs)];
    if (2 * a < b) forget_named(ours, state);
    if (2 * b < a) forget_named(theirs, state);
  }
}

/// Graphs that belong together are one in fewer than ten iterations (MRCLAM 6: at most 8).
constexpr int most_iterations = 30;

bool join_by(const Candidate& candidate, core::Nanoseconds t_ns, const TeamOptions& options, State& state) {
  State trial = state;
  const Component& into = state.components[candidate.into];
  const Component& from = state.components[candidate.from];
  const double apart_chi2 = into.chi2 + from.chi2;
  TeamJoin join;
  join.by = candidate.by;
  join.t_ns = t_ns;
  join.robot = static_cast<int>(into.robots.front());
  join.other = static_cast<int>(from.robots.front());
  join.merged = static_cast<int>(candidate.same.size());
  join.left_out = static_cast<int>(candidate.left_out.size());
  for (const std::size_t r : from.robots) trial.placed.push_back({r, trial.joins.size()});
  lay_together(candidate, trial);
  for (const std::size_t row : candidate.sightings) trial.sighting_rows[row].use = Use::used;
  join.sightings = static_cast<int>(candidate.sightings.size());
  try {
    if (!solve(candidate.into, trial, most_iterations)) return false;
    if (!passes(apart_chi2, 2 * (join.merged + join.sightings), trial, options, join)) return false;
    if (join.by == TeamJoin::By::names && !is_placed(join, trial, options.join)) return false;
    const Explained others = use_sightings(candidate.into, options.gate_probability, trial);
    if (others.refused > others.used) return false;
    forget_misread(candidate, trial);  // not earlier: the cost of their sightings is included in that of both apart
    if ((others.used > 0 || join.left_out > 0) && !solve(candidate.into, trial, most_iterations)) return false;
  } catch (const core::NumericalError&) {
    return false;
  }
  const core::Pose2 T_from = state.robots[from.robots.front()].clones.front().T_component_robot;
  const core::Pose2 T_into = trial.robots[from.robots.front()].clones.front().T_component_robot;
  join.T_component_other = core::compose(T_into, core::inverse(T_from));
  trial.joins.push_back(join);
  trial.evidence.push_back({into.robots, from.robots, candidate.sightings, state.sighting_rows.size()});
  state = std::move(trial);
  return true;
}

}  // namespace

bool join_components(Candidate candidate, core::Nanoseconds t_ns, const TeamOptions& options, State& state) {
  if (options.join.by_names) add_common_names(candidate, state);
  constexpr std::size_t enough = 4;
  const bool have_names = options.join.by_names && candidate.same.size() >= enough;
  NamesFit fit;
  if (have_names) fit = fit_names(candidate.into, candidate.from, candidate.same, options.join, state);
  if (fit.hopeless) return false;  // least squares over both graphs would look for a long time, and say the same
  if (join_by(candidate, t_ns, options, state)) return true;
  if (!fit.agree || fit.left_out.empty()) return false;
  candidate.same = std::move(fit.kept);
  candidate.left_out.insert(candidate.left_out.end(), fit.left_out.begin(), fit.left_out.end());
  candidate.T_into_from = fit.T_into_from;
  return join_by(candidate, t_ns, options, state);
}

}  // namespace helixnav::team
