// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/sim/ihgr_circle.hpp"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::sim {
namespace {

constexpr double turn_rad = core::pi / 180.0;
constexpr double period_s = 0.1;

void require(bool ok, const std::string& what) {
  if (!ok) throw core::InputError("ihgr-circle: " + what);
}

void check(const IhgrCircle& world) {
  const core::FieldOfView& view = world.field_of_view;
  require(world.features >= (world.close_features ? 5 : 0), "features must be at least 0, or 5 with close features");
  require(world.samples >= 0, "samples must not be negative");
  require(world.side_m > 0.0 && world.radius_m > 0.0, "side_m and radius_m must be positive");
  require(world.sigma_range_m > 0.0 && world.sigma_bearing_rad > 0.0, "the scanner's noise must be positive");
  require(world.sigma_distance_m >= 0.0 && world.sigma_turn_rad >= 0.0, "the odometry's noise must not be negative");
  require(view.min_range_m > 0.0 && view.max_range_m > view.min_range_m && std::isfinite(view.max_range_m),
          "the field of view must begin beyond 0 and be bounded");
  require(view.max_bearing_rad > view.min_bearing_rad, "the field of view must have an angle");
}

std::vector<core::TrueLandmark> draw_features(const IhgrCircle& world, const core::Pose2& T_map_world,
                                              std::uint64_t seed) {
  static const Eigen::Vector2d close_m[] = {{2.9, 2.3}, {2.6, 1.9}, {2.4, 1.9}, {2.5, 2.6}, {2.7, 2.8}};
  core::RandomStream random(seed, "sim.ihgr.features");
  std::vector<core::TrueLandmark> features;
  for (int i = 0; i < world.features; ++i) {
    const double x_m = random.uniform(0.0, world.side_m);
    const double y_m = random.uniform(0.0, world.side_m);
    const bool fixed = world.close_features && i < 5;
    const Eigen::Vector2d point_m = fixed ? close_m[i] : Eigen::Vector2d(x_m, y_m);
    features.push_back({static_cast<core::Label>(i), core::transform(T_map_world, point_m)});
  }
  return features;
}

/// The chord of an arc that turns by `turned_rad`, as an increment with the covariance of white noise on both.
core::Odometry increment(const IhgrCircle& world, double distance_m, double turned_rad, core::Nanoseconds t_ns) {
  const double half_rad = 0.5 * turned_rad;
  core::Odometry odometry;
  odometry.t_ns = t_ns;
  odometry.T_before_after = {distance_m * std::cos(half_rad), distance_m * std::sin(half_rad), turned_rad};
  Eigen::Matrix<double, 3, 2> J;
  J << std::cos(half_rad), -0.5 * distance_m * std::sin(half_rad),  //
      std::sin(half_rad), 0.5 * distance_m * std::cos(half_rad),    //
      0.0, 1.0;
  const Eigen::Vector2d variance(world.sigma_distance_m * world.sigma_distance_m,
                                 world.sigma_turn_rad * world.sigma_turn_rad);
  odometry.covariance = J * variance.asDiagonal() * J.transpose();
  return odometry;
}

bool is_in_view(const core::FieldOfView& view, double range_m, double bearing_rad) {
  return range_m >= view.min_range_m && range_m <= view.max_range_m && bearing_rad >= view.min_bearing_rad &&
         bearing_rad <= view.max_bearing_rad;
}

void look(const IhgrCircle& world, const core::Pose2& T_map_robot, core::Nanoseconds t_ns, core::RandomStream& random,
          core::Recording& recording) {
  core::Scan scan;
  scan.t_ns = t_ns;
  scan.field_of_view = world.field_of_view;
  std::vector<core::Label> labels;
  const core::Pose2 T_robot_map = core::inverse(T_map_robot);
  for (const core::TrueLandmark& feature : recording.true_landmarks) {
    const Eigen::Vector2d point_m = core::transform(T_robot_map, feature.point_m);
    const double range_m = point_m.norm();
    const double bearing_rad = std::atan2(point_m.y(), point_m.x());
    if (!is_in_view(world.field_of_view, range_m, bearing_rad)) continue;
    const double measured_m = random.normal(range_m, world.sigma_range_m);
    const double measured_rad = core::wrap_to_pi(random.normal(bearing_rad, world.sigma_bearing_rad));
    if (measured_m <= 0.0) continue;  // a scanner has no negative ranges: a miss
    scan.observations.push_back(
        core::make_range_bearing(measured_m, measured_rad, world.sigma_range_m, world.sigma_bearing_rad));
    labels.push_back(feature.label);
  }
  recording.true_poses.push_back({t_ns, T_map_robot});
  recording.labels.push_back(std::move(labels));
  recording.events.emplace_back(std::move(scan));
}

}  // namespace

core::Recording simulate_ihgr_circle(const IhgrCircle& world, std::uint64_t seed) {
  check(world);
  const core::Pose2 T_world_map(world.centre_m.x() + world.radius_m, world.centre_m.y(), core::pi / 2.0);
  core::Recording recording;
  recording.name = world.close_features ? "ihgr-circle-close" : "ihgr-circle";
  recording.true_landmarks = draw_features(world, core::inverse(T_world_map), seed);

  core::RandomStream odometry(seed, "sim.ihgr.odometry");
  core::RandomStream scanner(seed, "sim.ihgr.scanner");
  const double chord_m = 2.0 * world.radius_m * std::sin(0.5 * turn_rad);
  core::Pose2 T_map_robot;
  look(world, T_map_robot, 0, scanner, recording);
  for (int sample = 1; sample <= world.samples; ++sample) {
    const core::Nanoseconds t_ns = core::nanoseconds_from_seconds(sample * period_s);
    T_map_robot = core::compose(T_map_robot, increment(world, chord_m, turn_rad, t_ns).T_before_after);
    const double measured_m = odometry.normal(chord_m, world.sigma_distance_m);
    const double measured_rad = odometry.normal(turn_rad, world.sigma_turn_rad);
    recording.events.emplace_back(increment(world, measured_m, measured_rad, t_ns));
    look(world, T_map_robot, t_ns, scanner, recording);
  }
  return recording;
}

}  // namespace helixnav::sim
