// SPDX-License-Identifier: BSD-3-Clause
#include "team_driver.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace helixnav::sim {
namespace {

constexpr double speed_mps = 1.0;
constexpr double sigma_speed_mps = 0.05;
constexpr double sigma_turn_rad_per_s = 0.02;
constexpr double sigma_range_m = 0.1;
constexpr double sigma_bearing_rad = core::pi / 180.0;
constexpr double detection_probability = 0.9;

/// On an arc of constant curvature.
core::Pose2 arc(double distance_m, double turn_rad) {
  const double half_rad = 0.5 * turn_rad;
  const double chord_m = half_rad == 0.0 ? distance_m : distance_m * std::sin(half_rad) / half_rad;
  return {chord_m * std::cos(half_rad), chord_m * std::sin(half_rad), turn_rad};
}

core::Pose2 start_of(const TeamCircle& circle, double radius_m) {
  const Eigen::Vector2d arm(std::cos(circle.begin_rad), std::sin(circle.begin_rad));
  const Eigen::Vector2d at_m = circle.centre_m + radius_m * arm;
  return {at_m.x(), at_m.y(), core::wrap_to_pi(circle.begin_rad + circle.direction * 0.5 * core::pi)};
}

core::RandomStream stream(std::uint64_t seed, const char* what, std::size_t robot) {
  return core::RandomStream(seed, std::string("sim.team.") + what + '.' + std::to_string(robot));
}

}  // namespace

Scenario team_scanner(const TeamScene& scene, double clutter_per_scan) {
  Scenario scenario;
  scenario.scanner.T_robot_sensor = core::Pose2();
  scenario.scanner.field_of_view = {0.0, scene.reach_m, -core::pi, core::pi};
  scenario.scanner.detection_probability = detection_probability;
  scenario.scanner.clutter_per_scan = clutter_per_scan;
  scenario.true_noise.sigma_range_m = sigma_range_m;
  scenario.true_noise.sigma_bearing_rad = sigma_bearing_rad;
  scenario.assumed_noise = scenario.true_noise;
  return scenario;
}

TeamDriver::TeamDriver(const TeamScene& scene, std::size_t robot, const Scenario& scanner, const World& world,
                       std::uint64_t seed)
    : turn_rate_(scene.circles[robot].direction * speed_mps / scene.radius_m),
      reach_m_(scene.reach_m),
      pose_(start_of(scene.circles[robot], scene.radius_m)),
      odometry_(stream(seed, "odometry", robot)),
      others_(stream(seed, "others", robot)),
      scanner_(scanner, world, stream(seed, "scanner", robot).bits()) {}

core::Odometry TeamDriver::move(core::Nanoseconds t_ns) {
  constexpr double dt_s = team_period_s;
  pose_ = core::compose(pose_, arc(speed_mps * dt_s, turn_rate_ * dt_s));
  const double speed = odometry_.normal(speed_mps, sigma_speed_mps);
  const double turn = odometry_.normal(turn_rate_, sigma_turn_rad_per_s);
  core::Odometry odometry;
  odometry.t_ns = t_ns;
  odometry.T_before_after = arc(speed * dt_s, turn * dt_s);
  const double half_rad = 0.5 * turn * dt_s;
  Eigen::Matrix<double, 3, 2> J;
  J << dt_s * std::cos(half_rad), -0.5 * speed * dt_s * dt_s * std::sin(half_rad),  //
      dt_s * std::sin(half_rad), 0.5 * speed * dt_s * dt_s * std::cos(half_rad),    //
      0.0, dt_s;
  const Eigen::Vector2d sigma(sigma_speed_mps, sigma_turn_rad_per_s);
  odometry.covariance = J * sigma.cwiseAbs2().asDiagonal() * J.transpose();
  return odometry;
}

std::optional<core::Observation> TeamDriver::look_at(const Eigen::Vector2d& point_m) {
  const core::ObsVector z =
      core::predict_observation(core::ObservationKind::range_bearing, pose_, core::Pose2(), point_m).z_hat;
  if (z[0] > reach_m_ || !others_.bernoulli(detection_probability)) return std::nullopt;
  const double range_m = others_.normal(z[0], sigma_range_m);
  const double bearing_rad = core::wrap_to_pi(others_.normal(z[1], sigma_bearing_rad));
  if (range_m <= 0.0) return std::nullopt;
  return core::make_range_bearing(range_m, bearing_rad, sigma_range_m, sigma_bearing_rad);
}

}  // namespace helixnav::sim
