// SPDX-License-Identifier: BSD-3-Clause
#include "fuse_gps.hpp"

#include <cstddef>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/LU>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/interpolate.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/evaluation/alignment.hpp"
#include "truth_of_fused.hpp"

namespace helixnav::apps {
namespace {

/// Increments across a fix become two, so that it is used at the vehicle's place then. An increment whose start no event gives
/// stays whole.
void split_at_fixes(core::Recording& recording) {
  std::vector<core::Event> events;
  events.reserve(recording.events.size() + recording.true_positions.size());
  auto fix = recording.true_positions.begin();
  for (core::Event& event : recording.events) {
    auto* odometry = std::get_if<core::Odometry>(&event);
    while (odometry != nullptr && !events.empty()) {
      const core::Nanoseconds begin_ns = core::time_of(events.back());
      while (fix != recording.true_positions.end() && fix->t_ns <= begin_ns) ++fix;
      if (fix == recording.true_positions.end() || fix->t_ns >= odometry->t_ns) break;
      const double fraction = core::seconds(fix->t_ns - begin_ns) / core::seconds(odometry->t_ns - begin_ns);
      const auto [driven, rest] = core::split(*odometry, fraction, fix->t_ns);
      events.emplace_back(driven);
      *odometry = rest;
    }
    events.push_back(std::move(event));
  }
  recording.events = std::move(events);
}

struct Beginning {
  std::vector<Eigen::Vector2d> gps_m;  ///< the fixes
  std::vector<Eigen::Vector2d> way_m;  ///< the antenna then, dead-reckoned in the frame of the start
  std::vector<double> variance_m2;     ///< of the dead reckoning, larger of the two axes' sum
  std::size_t fixes = 0;
};

Beginning begin(const core::Recording& recording, double start_m) {
  Beginning beginning;
  core::Odometry way = core::no_motion(0);
  std::size_t event = 0;
  for (const core::TruePosition& fix : recording.true_positions) {
    for (; event < recording.events.size() && core::time_of(recording.events[event]) <= fix.t_ns; ++event) {
      const auto* odometry = std::get_if<core::Odometry>(&recording.events[event]);
      if (odometry != nullptr) way = core::chain(way, *odometry);
    }
    beginning.gps_m.push_back(fix.position_m);
    beginning.way_m.push_back(core::transform(way.T_before_after, recording.antenna_robot_m));
    beginning.variance_m2.push_back(way.covariance.topLeftCorner<2, 2>().trace());
    ++beginning.fixes;
    if ((beginning.way_m.back() - beginning.way_m.front()).norm() >= start_m) return beginning;
  }
  throw core::InputError(recording.name +
                         ": --gps fuse needs fixes over the first gps.start_m metres of driving, and "
                         "these are too few: choose a smaller gps.start_m or --gps truth");
}

core::PoseGaussian start_in_gps_frame(const Beginning& beginning, double sigma_m) {
  core::PoseGaussian start;
  start.mean = evaluation::align_rigidly(beginning.gps_m, beginning.way_m, 4.0 * sigma_m).T_a_b;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < beginning.way_m.size(); ++i) {
    const Eigen::Vector2d arm_m = core::rotation(start.mean.heading_rad) * beginning.way_m[i];
    Eigen::Matrix<double, 2, 3> J;
    J << 1.0, 0.0, -arm_m.y(), 0.0, 1.0, arm_m.x();
    information += J.transpose() * J / (sigma_m * sigma_m + beginning.variance_m2[i]);
  }
  const Eigen::Matrix3d covariance = 0.5 * static_cast<double>(beginning.fixes) * information.inverse();
  start.covariance = 0.5 * (covariance + covariance.transpose());
  return start;
}

}  // namespace

void fuse_gps(core::Recording& recording, const GpsSettings& settings) {
  if (recording.true_positions.empty()) throw core::InputError(recording.name + ": --gps fuse needs a log with GPS");
  split_at_fixes(recording);
  const Beginning beginning = begin(recording, settings.start_m);
  recording.start = start_in_gps_frame(beginning, settings.sigma_m);

  std::vector<core::Event> events;
  events.reserve(recording.events.size() + recording.true_positions.size());
  std::size_t event = 0;
  for (std::size_t i = beginning.fixes; i < recording.true_positions.size(); ++i) {
    core::AbsoluteFix fix;
    fix.t_ns = recording.true_positions[i].t_ns;
    fix.position_world_m = recording.true_positions[i].position_m;
    const double sigma_m =
        recording.true_positions[i].sigma_m > 0.0 ? recording.true_positions[i].sigma_m : settings.sigma_m;
    fix.covariance_m2 = sigma_m * sigma_m * Eigen::Matrix2d::Identity();
    fix.antenna_robot_m = recording.antenna_robot_m;
    for (; event < recording.events.size() && core::time_of(recording.events[event]) <= fix.t_ns; ++event) {
      events.push_back(std::move(recording.events[event]));
    }
    events.emplace_back(fix);
  }
  for (; event < recording.events.size(); ++event) events.push_back(std::move(recording.events[event]));
  recording.events = std::move(events);
  if (recording.true_poses.empty()) return;
  put_truth_in_frame_of_fixes(recording, settings.sigma_m);
  recording.true_positions.clear();
  recording.antenna_robot_m.setZero();
}

}  // namespace helixnav::apps
