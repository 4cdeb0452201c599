// SPDX-License-Identifier: BSD-3-Clause
#include "process.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <tuple>

#include "helixnav/core/chi2.hpp"
#include "unnamed_scan.hpp"

namespace helixnav::team {
namespace {

using core::LandmarkId;

/// What stands between a robot's last clone and the robot.
struct Place {
  std::size_t clone = 0;
  core::Odometry since;
};

bool is_uncertain(const core::Odometry& since, const TeamOptions& options) {
  const double sigma_m = std::sqrt(since.covariance.topLeftCorner<2, 2>().trace());
  return sigma_m > options.clone_sigma_m || std::sqrt(since.covariance(2, 2)) > options.clone_sigma_rad;
}

Place place_of(std::size_t robot, const TeamOptions& options, State& state) {
  if (is_uncertain(state.robots[robot].since, options)) clone_now(robot, state);
  return {state.robots[robot].clones.size() - 1, state.robots[robot].since};
}

/// The observation as made from the clone: the motion since then adds its noise.
LandmarkRow row_of(std::size_t robot, const Place& place, LandmarkId landmark, const core::Pose2& T_robot_sensor,
                   const core::Observation& observation) {
  LandmarkRow row{robot, place.clone, landmark, core::compose(place.since.T_before_after, T_robot_sensor), observation};
  const Eigen::Vector2d at_m =
      core::locate_landmark(observation, place.since.T_before_after, T_robot_sensor).point_world_m;
  const core::PredictedObservation predicted =
      core::predict_observation(observation.kind, place.since.T_before_after, T_robot_sensor, at_m);
  const core::ObsMatrix added = predicted.H_pose * place.since.covariance * predicted.H_pose.transpose();
  row.observation.R += 0.5 * (added + added.transpose());
  return row;
}

LandmarkId known_id(std::size_t robot, std::int64_t name, const TeamOptions& options, State& state) {
  const auto own = state.id_of_name.find({robot, name});
  if (own != state.id_of_name.end()) return state.resolve(own->second);
  if (!options.join.by_names) return core::no_landmark;
  for (const std::size_t other : state.of(robot).robots) {
    const auto theirs = state.id_of_name.find({other, name});
    if (theirs == state.id_of_name.end()) continue;
    state.id_of_name[{robot, name}] = theirs->second;
    return state.resolve(theirs->second);
  }
  return core::no_landmark;
}

LandmarkId new_id(const Birth& birth, State& state) {
  const auto id = static_cast<LandmarkId>(state.merged_into.size());
  state.merged_into.push_back(id);
  state.observations.push_back(0);
  state.refusals.push_back(0);
  state.moved.emplace_back();
  state.births.push_back(birth);
  return id;
}

void note_view(const core::Observation& observation, State& state) {
  const core::Pose2 at_sensor;
  const Eigen::Vector2d at_m = core::locate_landmark(observation, at_sensor, at_sensor).point_world_m;
  state.reach_m = std::max(state.reach_m, at_m.norm());
  state.widest_rad = std::max(state.widest_rad, std::abs(std::atan2(at_m.y(), at_m.x())));
}

/// Adds one observation to filter and graph: of the landmark given, or of a new one if none is.
core::AssociationReport observe(std::size_t robot, const core::Scan& scan, int index, bool is_named,
                                LandmarkId landmark, const TeamOptions& options, State& state) {
  const core::Pose2& T_robot_sensor = scan.T_robot_sensor;
  const core::Observation& observation = scan.observations[static_cast<std::size_t>(index)];
  core::AssociationReport report;
  report.observation = index;
  report.outcome = core::Outcome::matched;
  report.landmark = landmark;
  JointFilter& filter = state.of(robot).filter;
  const std::size_t slot = state.robots[robot].slot;
  const Place place = place_of(robot, options, state);
  if (report.landmark == core::no_landmark) {
    report.landmark = new_id({robot, scan.t_ns, index, is_named}, state);
    report.outcome = core::Outcome::augmented;
    filter.augment(slot, report.landmark, T_robot_sensor, observation);
  } else {
    const double gate = core::chi2_quantile(options.gate_probability, static_cast<int>(observation.z.size()));
    const JointFilter::Judged judged = filter.observe(slot, report.landmark, T_robot_sensor, observation, gate);
    report.nis = judged.nis;
    report.dof = judged.dof;
    if (!judged.accepted) {
      report.outcome = core::Outcome::rejected;
      return report;
    }
  }
  state.landmark_rows.push_back(row_of(robot, place, report.landmark, T_robot_sensor, observation));
  state.landmark_rows.back().scan = state.robots[robot].scans;
  ++state.observations[static_cast<std::size_t>(report.landmark)];
  note_view(observation, state);
  state.of(robot).news = true;
  return report;
}

core::AssociationReport unused(int index, core::Outcome outcome) {
  core::AssociationReport report;
  report.observation = index;
  report.outcome = outcome;
  return report;
}

using Reports = std::vector<core::AssociationReport>;

/// Forgets landmarks and all that was seen of them.
void forget(const std::set<LandmarkId>& forgotten, State& state) {
  for (const LandmarkId id : forgotten) state.observations[static_cast<std::size_t>(id)] = 0;
  std::vector<LandmarkRow>& rows = state.landmark_rows;
  const auto is_of_them = [&](const LandmarkRow& row) { return forgotten.count(state.resolve(row.landmark)) > 0; };
  rows.erase(std::remove_if(rows.begin(), rows.end(), is_of_them), rows.end());
  for (Component& component : state.components) component.filter.remove({forgotten.begin(), forgotten.end()});
}

core::PointGaussian place_seen(std::size_t robot, const core::Pose2& T_robot_sensor,
                               const core::Observation& observation, State& state) {
  const core::PoseGaussian pose = state.of(robot).filter.pose(state.robots[robot].slot);
  const core::LocatedLandmark at = core::locate_landmark(observation, pose.mean, T_robot_sensor);
  const Eigen::Matrix2d of_pose = at.G_pose * pose.covariance * at.G_pose.transpose();
  return {at.point_world_m, of_pose + at.G_z * observation.R * at.G_z.transpose()};
}

/// A landmark that was first seen under another's name is where nobody sees it again: more than twice as many of its
/// sightings are refused as it has. So it is after it was moved. It is begun anew with the next one.
void note_refused(std::size_t robot, LandmarkId id, const core::PointGaussian& place, State& state) {
  constexpr int least = 3;
  const auto at = static_cast<std::size_t>(id);
  SightingCounts& counts = state.robots[robot].named;
  ++counts.refused;
  state.moved[at].refuse(robot, place, counts);
  const bool is_misplaced = ++state.refusals[at] > 2 * state.observations[at] + least;
  if (is_misplaced || state.moved[at].has_moved(state.observations[at], counts)) forget_named(id, state);
}

void note_accepted(std::size_t robot, LandmarkId id, State& state) {
  ++state.robots[robot].named.accepted;
  state.moved[static_cast<std::size_t>(id)].accept();
}

Reports observe_by_name(std::size_t robot, const NamedScan& named, const TeamOptions& options, State& state) {
  Reports reports;
  std::set<std::int64_t> seen;
  for (int i = 0; i < static_cast<int>(named.names.size()); ++i) {
    const std::int64_t name = named.names[static_cast<std::size_t>(i)];
    if (name < 0 || !seen.insert(name).second) {
      reports.push_back(unused(i, core::Outcome::rejected));
      continue;
    }
    const LandmarkId known = known_id(robot, name, options, state);
    reports.push_back(observe(robot, named.scan, i, true, known, options, state));
    if (reports.back().outcome == core::Outcome::augmented) state.id_of_name[{robot, name}] = reports.back().landmark;
    if (reports.back().outcome == core::Outcome::matched) note_accepted(robot, known, state);
    if (reports.back().outcome != core::Outcome::rejected) continue;
    const core::Observation& observation = named.scan.observations[static_cast<std::size_t>(i)];
    note_refused(robot, known, place_seen(robot, named.scan.T_robot_sensor, observation, state), state);
  }
  return reports;
}

void take(std::size_t robot, const core::Odometry& motion, State& state) {
  Robot& moved = state.robots[robot];
  moved.since = core::chain(moved.since, motion);
  moved.since.t_ns = motion.t_ns;
  state.of(robot).filter.predict(moved.slot, motion);
}

/// Unmeasured motion before a scan, of mean zero, between two poses of the graph.
void slip(std::size_t robot, core::Nanoseconds t_ns, const supervisor::Slip& slip, State& state) {
  core::Odometry unmeasured = core::no_motion(t_ns);
  unmeasured.covariance = slip.covariance;
  take(robot, unmeasured, state);
  state.slips.push_back({t_ns, static_cast<int>(robot), slip.figures});
}

Reports observe_by_place(std::size_t robot, const core::Scan& scan, const TeamOptions& options, State& state) {
  const UnnamedScan read = read_unnamed(robot, scan, options, state);
  if (read.slip) slip(robot, scan.t_ns, *read.slip, state);
  Reports reports = read.fate;
  for (const int i : read.order) {
    core::AssociationReport& one = reports[static_cast<std::size_t>(i)];
    const double margin_nats = one.margin_nats;
    one = one.outcome == core::Outcome::ambiguous ? unused(i, core::Outcome::ambiguous)
                                                  : observe(robot, scan, i, false, one.landmark, options, state);
    one.margin_nats = margin_nats;
  }
  return reports;
}

core::StepReport take(std::size_t robot, const NamedScan& named, const TeamOptions& options, State& state) {
  core::StepReport report;
  const std::size_t slips = state.slips.size();
  report.associations = named.names.empty() ? observe_by_place(robot, named.scan, options, state)
                                            : observe_by_name(robot, named, options, state);
  for (const core::AssociationReport& association : report.associations) {
    if (association.outcome != core::Outcome::matched) continue;
    report.joint_nis += association.nis;
    report.joint_dof += association.dof;
  }
  if (state.slips.size() > slips) report.decisions.emplace_back(state.slips.back().decision);
  const JointFilter& filter = state.of(robot).filter;
  report.step = state.robots[robot].scans++;
  report.t_ns = named.scan.t_ns;
  report.pose = filter.pose(state.robots[robot].slot);
  report.active_landmarks = report.mapped_landmarks = static_cast<int>(filter.ids().size());
  return report;
}

/// Whether another robot of the component is where one was seen: then it was probably taken for the wrong one.
bool fits_another(const SightingRow& row, double gate, const State& state) {
  const Component& component = state.components[state.robots[row.robot].component];
  return std::any_of(component.robots.begin(), component.robots.end(), [&](std::size_t other) {
    if (other == row.robot || other == row.seen) return false;
    return component.filter
        .judge_sighting(state.robots[row.robot].slot, state.robots[other].slot, row.T_robot_sensor, row.observation,
                        gate)
        .accepted;
  });
}

void take(std::size_t robot, const core::RobotSighting& sighting, const TeamOptions& options, State& state) {
  SightingRow row;
  row.robot = robot;
  row.seen = static_cast<std::size_t>(sighting.seen);
  row.t_ns = sighting.t_ns;
  row.clone = clone_now(row.robot, state);
  row.seen_clone = clone_now(row.seen, state);
  row.T_robot_sensor = sighting.T_robot_sensor;
  row.observation = sighting.observation;
  if (state.robots[row.robot].component == state.robots[row.seen].component) {
    Component& component = state.of(row.robot);
    const double gate = core::chi2_quantile(options.gate_probability, static_cast<int>(row.observation.z.size()));
    const JointFilter::Judged judged = component.filter.sight(state.robots[row.robot].slot, state.robots[row.seen].slot,
                                                              row.T_robot_sensor, row.observation, gate);
    row.nis = judged.nis;
    row.use = judged.accepted ? SightingRow::Use::used : SightingRow::Use::refused;
    row.fits_another = !judged.accepted && fits_another(row, gate, state);
    state.news_of_joins = state.news_of_joins || !judged.accepted;
    component.news = component.news || judged.accepted;
  }
  state.sighting_rows.push_back(row);
}

int rank_of(const Entry& entry) { return static_cast<int>(entry.what.index()); }

/// Of two sightings by one robot at the same time, one may wait longer than the other.
int seen_by(const Entry& entry) {
  const auto* sighting = std::get_if<core::RobotSighting>(&entry.what);
  return sighting == nullptr ? 0 : sighting->seen;
}

}  // namespace

core::Nanoseconds Entry::t_ns() const {
  if (const auto* motion = std::get_if<core::Odometry>(&what)) return motion->t_ns;
  if (const auto* sighting = std::get_if<core::RobotSighting>(&what)) return sighting->t_ns;
  return std::get<NamedScan>(what).scan.t_ns;
}

bool before(const Entry& a, const Entry& b) {
  const auto key = [](const Entry& entry) {
    return std::make_tuple(entry.t_ns(), rank_of(entry), entry.robot, seen_by(entry));
  };
  return key(a) < key(b);
}

State begin(const std::vector<std::optional<core::PoseGaussian>>& starts) {
  State state;
  std::optional<std::size_t> common;
  for (std::size_t r = 0; r < starts.size(); ++r) {
    Robot& robot = state.robots.emplace_back();
    robot.start = starts[r];
    Clone& clone = robot.clones.emplace_back();
    if (starts[r]) clone.T_component_robot = starts[r]->mean;
    if (starts[r] && common) {
      robot.component = *common;
    } else {
      robot.component = state.components.size();
      state.components.emplace_back();
      if (starts[r]) common = robot.component;
    }
    robot.slot = state.of(r).robots.size();
    state.of(r).robots.push_back(r);
  }
  for (Component& component : state.components) {
    std::vector<core::Pose2> poses;
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * component.robots.size()),
                                              static_cast<Eigen::Index>(3 * component.robots.size()));
    for (const std::size_t r : component.robots) {
      const auto column = static_cast<Eigen::Index>(3 * poses.size());
      if (starts[r]) P.block<3, 3>(column, column) = starts[r]->covariance;
      poses.push_back(state.robots[r].clones.front().T_component_robot);
    }
    component.filter = JointFilter(poses, {}, {}, P);
  }
  return state;
}

void forget_named(LandmarkId id, State& state) {
  for (auto name = state.id_of_name.begin(); name != state.id_of_name.end();) {
    name = state.resolve(name->second) == id ? state.id_of_name.erase(name) : std::next(name);
  }
  forget({id}, state);
}

void drop_seen_once(State& state) {
  std::set<LandmarkId> dropped;
  const std::size_t ids = state.births.size();
  for (std::size_t id = 0; id < state.born_before_solution; ++id) {
    if (!state.births[id].named && state.observations[id] == 1 &&
        state.merged_into[id] == static_cast<LandmarkId>(id)) {
      dropped.insert(static_cast<LandmarkId>(id));
    }
  }
  state.born_before_solution = ids;
  if (!dropped.empty()) forget(dropped, state);
}

std::size_t clone_now(std::size_t robot, State& state) {
  Robot& moved = state.robots[robot];
  const bool stood = moved.since.T_before_after.vector().isZero(0.0) && moved.since.covariance.isZero(0.0);
  if (!stood) {
    moved.clones.push_back({moved.since.t_ns, state.of(robot).filter.pose(moved.slot).mean, moved.since});
    moved.since = core::no_motion(moved.since.t_ns);
  }
  return moved.clones.size() - 1;
}

std::optional<core::StepReport> process(const Entry& entry, const TeamOptions& options, State& state) {
  if (const auto* motion = std::get_if<core::Odometry>(&entry.what)) {
    take(entry.robot, *motion, state);
  } else if (const auto* sighting = std::get_if<core::RobotSighting>(&entry.what)) {
    take(entry.robot, *sighting, options, state);
  } else {
    return take(entry.robot, std::get<NamedScan>(entry.what), options, state);
  }
  return std::nullopt;
}

}  // namespace helixnav::team
