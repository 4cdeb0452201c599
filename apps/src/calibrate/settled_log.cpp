// SPDX-License-Identifier: BSD-3-Clause
#include "settled_log.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <variant>

#include "drifting_level.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/smoothing/optimize.hpp"
#include "helixnav/smoothing/residuals.hpp"
#include "helixnav/smoothing/undetermined.hpp"
#include "stop_if_interrupted.hpp"
#include "without_fixes.hpp"

namespace helixnav::apps {
namespace {

/// [observation] range; 0 if bearing-only.
std::vector<double> ranges_of(const core::Scan& scan) {
  std::vector<double> ranges_m;
  for (const core::Observation& seen : scan.observations) {
    switch (seen.kind) {
      case core::ObservationKind::range_bearing:
      case core::ObservationKind::range:
        ranges_m.push_back(seen.z[0]);
        break;
      case core::ObservationKind::cartesian:
        ranges_m.push_back(seen.z.norm());
        break;
      case core::ObservationKind::bearing:
        ranges_m.push_back(0.0);
        break;
    }
  }
  return ranges_m;
}

MotionsAndMountings measured(const core::Recording& recording) {
  MotionsAndMountings result;
  core::Pose2 moved;
  for (const core::Event& event : recording.events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      moved = core::compose(moved, odometry->T_before_after);
    } else if (const auto* scan = std::get_if<core::Scan>(&event)) {
      result.times.push_back(scan->t_ns);
      result.moved.push_back(moved);
      result.mounting.push_back(scan->T_robot_sensor);
      result.ranges_m.push_back(ranges_of(*scan));
      moved = core::Pose2();
    }
  }
  return result;
}

/// [pose] its first scan, −1 if it has none.
std::vector<int> first_scans(const SmoothingTask& task) {
  std::vector<int> first(task.problem.graph.poses.size(), -1);
  for (std::size_t k = task.pose_of_step.size(); k-- > 0;) first[at(task.pose_of_step[k])] = static_cast<int>(k);
  return first;
}

core::Pose2 moved_between(const MotionsAndMountings& log, int from, int to) {
  core::Pose2 moved;
  for (int k = from + 1; k <= to; ++k) moved = core::compose(moved, log.moved[at(k)]);
  return moved;
}

Eigen::Vector3d slope(const core::Pose2& from, const core::Pose2& to, double nudge) {
  Eigen::Vector3d difference = to.vector() - from.vector();
  difference.z() = core::wrap_to_pi(difference.z());
  return difference / nudge;
}

smoothing::ConstantDerivative none_of(const SmoothingTask& task) {
  const core::LandmarkGraph& graph = task.problem.graph;
  smoothing::ConstantDerivative derivative;
  derivative.increments.assign(graph.pose_edges.size(), Eigen::Vector3d::Zero());
  derivative.mountings.assign(graph.landmark_edges.size(), Eigen::Vector3d::Zero());
  return derivative;
}

/// The solved increment minus the measured one.
Eigen::Vector3d left_over(const core::LandmarkGraph& graph, const core::LandmarkGraph::PoseEdge& edge) {
  Eigen::Vector3d e =
      core::between(graph.poses[at(edge.from)].T_world_robot, graph.poses[at(edge.to)].T_world_robot).vector() -
      edge.T_from_to.vector();
  e.z() = core::wrap_to_pi(e.z());
  return e;
}

/// Unit vector from the sensor to the solved landmark, in the frame of the vehicle. If it were the measured one, its error would be that
/// of the measured bearing, and the derivative of a bearing would have its residual's sign: offsets of ranges came out 15 mm low.
Eigen::Vector2d towards_landmark(const core::LandmarkGraph& graph, const core::LandmarkGraph::LandmarkEdge& edge) {
  const core::Pose2& T_world_robot = graph.poses[at(edge.pose)].T_world_robot;
  const Eigen::Vector2d point_m =
      core::transform(core::inverse(T_world_robot), graph.landmarks[at(edge.landmark)].point_m);
  return (point_m - edge.T_robot_sensor.position_m()).normalized();
}

smoothing::ConstantDerivative by_reading(const NudgedLog& log, std::size_t c, const SmoothingTask& task) {
  const core::LandmarkGraph& graph = task.problem.graph;
  const double nudge = log.constants[c].nudge;
  const MotionsAndMountings& nudged = log.nudged[c];
  const Eigen::Vector3d& factor_of = log.constants[c].factor_of;
  const bool multiplies = !factor_of.isZero(0.0);
  smoothing::ConstantDerivative derivative = none_of(task);
  const std::vector<int> first = first_scans(task);
  for (std::size_t i = 0; i < graph.pose_edges.size(); ++i) {
    const auto& edge = graph.pose_edges[i];
    const int from = first[at(edge.from)], to = first[at(edge.to)];
    if (from < 0) continue;  // motion before the first scan carries no information: no landmark is seen before it
    derivative.increments[i] = slope(moved_between(log.told, from, to), moved_between(nudged, from, to), nudge);
    if (multiplies) derivative.increments[i] += factor_of.cwiseProduct(left_over(graph, edge)) / log.values[c];
  }
  for (std::size_t k = 0; k < task.edge_of.size(); ++k) {
    for (std::size_t i = 0; i < task.edge_of[k].size(); ++i) {
      const int edge = task.edge_of[k][i];
      if (edge < 0) continue;
      // A longer range has the effect of a sensor nearer to the landmark.
      const double farther_m = nudged.ranges_m[k].at(i) - log.told.ranges_m[k].at(i);
      Eigen::Vector3d& mounting = derivative.mountings[at(edge)];
      mounting = slope(log.told.mounting[k], nudged.mounting[k], nudge);
      if (farther_m != 0.0) {
        mounting.head<2>() += farther_m / nudge * towards_landmark(graph, graph.landmark_edges[at(edge)]);
      }
    }
  }
  return derivative;
}

/// (x, y, heading) per second in the frame of the vehicle, at given times.
struct Rates {
  std::vector<core::Nanoseconds> times;
  std::vector<Eigen::Vector3d> values;
};

/// Between every sixth of the solved poses that have a scan.
Rates solved_rates(const NudgedLog& log, const SmoothingTask& task, const std::vector<int>& first) {
  constexpr std::size_t every = 6;  // so far apart that the remaining noise is white
  const auto& poses = task.problem.graph.poses;
  std::vector<std::size_t> with_scan;
  for (std::size_t pose = 0; pose < first.size(); ++pose) {
    if (first[pose] >= 0) with_scan.push_back(pose);
  }
  const auto time_of = [&](std::size_t i) { return log.told.times[at(first[with_scan[i]])]; };
  Rates rates;
  for (std::size_t i = 0; i + every < with_scan.size(); i += every) {
    const double duration_s = core::seconds(time_of(i + every) - time_of(i));
    if (!(duration_s > 0.0)) continue;
    const core::Pose2& here = poses[with_scan[i + every / 2]].T_world_robot;
    const core::Pose2 from = core::between(here, poses[with_scan[i]].T_world_robot);
    const core::Pose2 to = core::between(here, poses[with_scan[i + every]].T_world_robot);
    rates.times.push_back(time_of(i) + (time_of(i + every) - time_of(i)) / 2);
    rates.values.push_back(slope(from, to, duration_s));
  }
  return rates;
}

/// As the vehicle is expected to have moved: noise on a steady speed would suggest a delay that cannot be observed.
void take_out_noise(Rates& rates) {
  const auto n = static_cast<Eigen::Index>(rates.values.size());
  Eigen::VectorXd apart_s(std::max<Eigen::Index>(n - 1, 0));
  for (Eigen::Index i = 0; i + 1 < n; ++i)
    apart_s[i] = core::seconds(rates.times[static_cast<std::size_t>(i) + 1] - rates.times[static_cast<std::size_t>(i)]);
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::VectorXd seen(n);
    for (Eigen::Index i = 0; i < n; ++i) seen[i] = rates.values[static_cast<std::size_t>(i)][axis];
    const Eigen::VectorXd level = drifting_level(seen, apart_s);
    for (Eigen::Index i = 0; i < n; ++i) rates.values[static_cast<std::size_t>(i)][axis] = level[i];
  }
}

/// Between the two beside it.
Eigen::Vector3d rate_at(const Rates& rates, core::Nanoseconds t_ns) {
  if (rates.times.empty()) return Eigen::Vector3d::Zero();
  const auto after = std::upper_bound(rates.times.begin(), rates.times.end(), t_ns);
  if (after == rates.times.begin()) return rates.values.front();
  if (after == rates.times.end()) return rates.values.back();
  const auto i = static_cast<std::size_t>(after - rates.times.begin());
  const double share = core::seconds(t_ns - rates.times[i - 1]) / core::seconds(rates.times[i] - rates.times[i - 1]);
  return (1.0 - share) * rates.values[i - 1] + share * rates.values[i];
}

smoothing::ConstantDerivative by_delay(const NudgedLog& log, const SmoothingTask& task) {
  smoothing::ConstantDerivative derivative = none_of(task);
  const std::vector<int> first = first_scans(task);
  Rates rates = solved_rates(log, task, first);
  take_out_noise(rates);
  for (std::size_t k = 0; k < task.edge_of.size(); ++k) {
    const int pose = task.pose_of_step[k];
    if (first[at(pose)] < 0) continue;
    const Eigen::Vector3d rate = rate_at(rates, log.told.times[k]);
    const core::Pose2& mounting = log.told.mounting[k];
    const Eigen::Vector3d back(-rate.x() + rate.z() * mounting.y_m, -rate.y() - rate.z() * mounting.x_m, -rate.z());
    for (const int edge : task.edge_of[k]) {
      if (edge >= 0) derivative.mountings[at(edge)] = back;
    }
  }
  return derivative;
}

SmoothingTask begun_task(const core::Recording& driven, const Ids& ids, const core::LandmarkGraph& from) {
  SmoothingTask task = task_from_recording(driven, ids);
  core::LandmarkGraph& graph = task.problem.graph;
  if (graph.poses.size() <= from.poses.size()) {  // it may end earlier
    std::copy_n(from.poses.begin(), graph.poses.size(), graph.poses.begin());
    core::locate_landmarks(graph);
  }
  std::map<std::int64_t, Eigen::Vector2d> point_of;
  for (const auto& landmark : from.landmarks) point_of[landmark.name] = landmark.point_m;
  for (auto& landmark : graph.landmarks) {
    if (const auto known = point_of.find(landmark.name); known != point_of.end()) landmark.point_m = known->second;
  }
  return task;
}

/// Takes all observations of landmarks out of `ids`.
void leave_out(const std::set<std::int64_t>& names, Ids& ids) {
  for (auto& of_scan : ids) {
    for (std::int64_t& id : of_scan) id = names.count(id) > 0 ? core::no_label : id;
  }
}

/// Takes out of `ids` the landmarks that a task hardly determines, which may diverge until it cannot be solved; returns
/// whether there were any.
bool leave_out_hardly_determined(const SmoothingTask& task, Ids& ids, std::set<std::int64_t>& left_out) {
  std::set<std::int64_t> names;
  for (const int landmark : smoothing::hardly_determined_landmarks(task.problem.graph))
    names.insert(task.problem.graph.landmarks[at(landmark)].name);
  leave_out(names, ids);
  left_out.insert(names.begin(), names.end());
  return !names.empty();
}

/// Without landmarks that are undetermined, at the start or where the solver is led.
SmoothingTask solve_once(const core::Recording& driven, Ids& ids, const core::LandmarkGraph& from,
                         const smoothing::Options& solver, std::set<std::int64_t>& left_out) {
  while (true) {
    SmoothingTask task = begun_task(driven, ids, from);
    if (leave_out_hardly_determined(task, ids, left_out)) continue;
    try {
      smoothing::optimize(task.problem, solver);
      return task;
    } catch (const smoothing::UndeterminedLandmark& error) {
      leave_out({error.name}, ids);
      left_out.insert(error.name);
    }
  }
}

/// Takes out of `ids` the observations of a landmark that coincides with the sensor; returns whether there were any. If wrong
/// associations contradict each other the sum of squares may be least there, and it has no derivative.
bool leave_out_at_sensors(const SmoothingTask& solved, Ids& ids) {
  constexpr double nearest_m = 1e-3;  // nothing is seen at such a short range
  const core::LandmarkGraph& graph = solved.problem.graph;
  bool left_out = false;
  for (std::size_t k = 0; k < ids.size(); ++k) {
    for (std::size_t i = 0; i < ids[k].size(); ++i) {
      if (solved.edge_of[k][i] < 0) continue;
      const auto& edge = graph.landmark_edges[at(solved.edge_of[k][i])];
      if (edge.observation.kind == core::ObservationKind::cartesian) continue;
      const core::Pose2 sensor = core::compose(graph.poses[at(edge.pose)].T_world_robot, edge.T_robot_sensor);
      if ((graph.landmarks[at(edge.landmark)].point_m - sensor.position_m()).norm() > nearest_m) continue;
      ids[k][i] = core::no_label;
      left_out = true;
    }
  }
  return left_out;
}

}  // namespace

Ids without_returns(const Ids& ids) {
  constexpr std::size_t while_scans = 10;
  struct Passage {
    std::int64_t id = 0;
    std::size_t last_scan = 0;
  };
  std::map<std::int64_t, Passage> passages;
  Ids apart = ids;
  std::int64_t next = 0;  // names not used before, so that nobody confuses them
  for (const auto& of_scan : ids) {
    for (const std::int64_t id : of_scan) next = std::max(next, id + 1);
  }
  for (std::size_t k = 0; k < apart.size(); ++k) {
    for (std::int64_t& id : apart[k]) {
      if (id < 0) continue;
      const auto [found, begun] = passages.try_emplace(id);
      if (begun || k - found->second.last_scan > while_scans) found->second.id = next++;
      found->second.last_scan = k;
      id = found->second.id;
    }
  }
  return apart;
}

Ids without_outliers(const Ids& ids, const SmoothingTask& solved) {
  const core::LandmarkGraph& graph = solved.problem.graph;
  std::vector<double> nis(graph.landmark_edges.size(), 0.0);
  const std::size_t all = graph.pose_edges.size() + graph.landmark_edges.size();
  for (const smoothing::Residual& residual : smoothing::largest_residuals(solved.problem, all)) {
    if (residual.kind == smoothing::Residual::Kind::landmark) nis[at(residual.edge)] = residual.nis;
  }
  if (nis.empty()) return ids;
  std::vector<double> sorted = nis;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  constexpr double most_medians = 15.0;  // exceeded by one of 30 000 with normal noise of two rows
  Ids kept = ids;
  for (std::size_t k = 0; k < kept.size(); ++k) {
    for (std::size_t i = 0; i < kept[k].size(); ++i) {
      const int edge = solved.edge_of[k][i];
      if (edge >= 0 && nis[at(edge)] > most_medians * *middle) kept[k][i] = core::no_label;
    }
  }
  return kept;
}

smoothing::Options patient_solver(double tolerance_chi2) {
  smoothing::Options solver;
  solver.first_damping = 1e-8;
  solver.tolerance_chi2 = tolerance_chi2;
  solver.go_on = [](const std::vector<smoothing::Iteration>&) {
    stop_if_interrupted();
    return true;
  };
  return solver;
}

SmoothingTask solve_log(const core::Recording& recording, Ids ids, const core::LandmarkGraph& from,
                        const smoothing::RobustKernel& kernel) {
  const core::Recording driven = without_fixes(recording);
  smoothing::Options solver = patient_solver(1e-4);
  solver.kernel = kernel;
  std::set<std::int64_t> left_out;
  SmoothingTask task = solve_once(driven, ids, from, solver, left_out);
  while (leave_out_at_sensors(task, ids) || leave_out_hardly_determined(task, ids, left_out))
    task = solve_once(driven, ids, task.problem.graph, solver, left_out);
  task.undetermined_landmarks = static_cast<int>(left_out.size());
  return task;
}

bool same(const MotionsAndMountings& a, const MotionsAndMountings& b) {
  const auto equal = [](const core::Pose2& one, const core::Pose2& other) { return one.vector() == other.vector(); };
  return std::equal(a.moved.begin(), a.moved.end(), b.moved.begin(), b.moved.end(), equal) &&
         std::equal(a.mounting.begin(), a.mounting.end(), b.mounting.begin(), b.mounting.end(), equal) &&
         a.ranges_m == b.ranges_m;
}

NudgedLog nudge(const ReadLog& read, const Settings& settings, const std::vector<VehicleConstant>& constants,
                const core::Recording& told) {
  NudgedLog log;
  log.told = measured(told);
  log.constants = constants;
  for (const VehicleConstant& constant : constants) {
    Settings nudged = settings;
    constant.add(nudged, constant.nudge);
    log.values.push_back(constant.value(settings));
    log.nudged.push_back(constant.nudge > 0.0 ? measured(read(nudged)) : MotionsAndMountings());
    if (constant.nudge > 0.0 && log.nudged.back().moved.size() != log.told.moved.size()) {
      throw core::InputError(told.name + ": with another " + constant.key + " the log has another number of scans");
    }
  }
  return log;
}

std::vector<smoothing::ConstantDerivative> derivatives_of(const NudgedLog& log, const SmoothingTask& task) {
  std::vector<smoothing::ConstantDerivative> derivatives;
  for (std::size_t c = 0; c < log.constants.size(); ++c) {
    derivatives.push_back(log.constants[c].nudge > 0.0 ? by_reading(log, c, task) : by_delay(log, task));
  }
  return derivatives;
}

}  // namespace helixnav::apps
