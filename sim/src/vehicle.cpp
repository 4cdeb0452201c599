// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle.hpp"

#include <algorithm>
#include <cmath>

#include "helixnav/core/errors.hpp"

namespace helixnav::sim {
namespace {

constexpr double steering_limit_rad = 0.6;
constexpr double search_ahead_samples = 4.0;  // how far ahead of the last place on the route the next one is sought

/// Steering of the arc that leads from the rear axle through the target.
double pursue(const Eigen::Vector2d& target_robot_m, double wheelbase_m) {
  const double curvature_per_m = 2.0 * target_robot_m.y() / target_robot_m.squaredNorm();
  return std::clamp(std::atan(wheelbase_m * curvature_per_m), -steering_limit_rad, steering_limit_rad);
}

core::AckermannSample steer(const core::Pose2& T_world_robot, const Eigen::Vector2d& target_world_m,
                            const VehicleOptions& vehicle) {
  const core::AckermannGeometry& g = vehicle.geometry;
  core::AckermannSample sample;
  sample.steering_rad = pursue(core::transform(core::inverse(T_world_robot), target_world_m), g.wheelbase_m);
  // The encoder's wheel is not at the centre of the axle: it runs slower on the inside of a curve.
  sample.wheel_speed_mps =
      vehicle.speed_mps * (1.0 - g.encoder_offset_m / g.wheelbase_m * std::tan(sample.steering_rad));
  sample.duration_s = vehicle.odometry_period_s;
  return sample;
}

}  // namespace

std::vector<DriveStep> drive(const Route& route, double drive_m, const VehicleOptions& vehicle) {
  const double sample_m = vehicle.speed_mps * vehicle.odometry_period_s;
  const auto most_steps = static_cast<std::size_t>(2.0 * drive_m / sample_m) + 2;
  std::vector<DriveStep> steps;
  DriveStep step;
  while (step.along_m < drive_m) {
    if (steps.size() == most_steps) throw core::NumericalError("sim: the vehicle cannot follow its route");
    step.sample = steer(step.T_world_robot, route.at(step.along_m + vehicle.lookahead_m), vehicle);
    step.T_world_robot = core::compose(
        step.T_world_robot, core::ackermann_increment(vehicle.geometry, {0.0, 0.0}, step.sample).T_before_after);
    step.along_m = route.nearest_along_m(step.T_world_robot.position_m(),
                                         {step.along_m, step.along_m + search_ahead_samples * sample_m});
    steps.push_back(step);
  }
  return steps;
}

}  // namespace helixnav::sim
