// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/systematic_errors.hpp"

#include <algorithm>

#include "helixnav/core/se2.hpp"

namespace helixnav::supervisor {
namespace {

/// A range that would not stay positive keeps half of itself.
double lengthened(double range_m, double short_m) { return std::max(range_m + short_m, 0.5 * range_m); }

void lengthen(double short_m, core::Observation& observation) {
  switch (observation.kind) {
    case core::ObservationKind::range_bearing:
    case core::ObservationKind::range:
      observation.z(0) = lengthened(observation.z(0), short_m);
      break;
    case core::ObservationKind::cartesian:
      if (const double range_m = observation.z.norm(); range_m > 0.0) {
        observation.z *= lengthened(range_m, short_m) / range_m;
      }
      break;
    case core::ObservationKind::bearing:
      break;
  }
}

}  // namespace

SystematicErrors both(const SystematicErrors& first, const SystematicErrors& then) {
  SystematicErrors sum(SystematicErrors::Vector(first.vector() + then.vector()));
  sum.too_long = (1.0 + first.too_long) * (1.0 + then.too_long) - 1.0;
  return sum;
}

/// An increment is short: its turn counts half for its direction.
core::Odometry without(const SystematicErrors& errors, const core::Odometry& measured, const TimeMoved& time) {
  const core::Pose2& moved = measured.T_before_after;
  const double unsure_rad = 0.5 * errors.turn_rad_per_s * time.silent_s;
  const double turn_rad = errors.turn_rad_per_s * time.seconds - unsure_rad + errors.turn_rad_per_m * moved.x_m;
  const Eigen::Vector2d way_m = core::rotation(-0.5 * turn_rad) * moved.position_m() / (1.0 + errors.too_long);
  core::Odometry odometry = measured;
  odometry.T_before_after = {way_m.x(), way_m.y(), moved.heading_rad - turn_rad};
  odometry.covariance(2, 2) += unsure_rad * unsure_rad;
  return odometry;
}

core::Scan without(const SystematicErrors& errors, core::Scan measured) {
  const core::Pose2& stated = measured.T_robot_sensor;
  measured.T_robot_sensor = {stated.x_m, stated.y_m, stated.heading_rad + errors.heading_rad};
  for (core::Observation& observation : measured.observations) lengthen(errors.short_m, observation);
  return measured;
}

Eigen::Matrix<double, 3, SystematicErrors::count> derivative_without_errors(const core::Pose2& T_before_after,
                                                                            double seconds) {
  const double x_m = T_before_after.x_m, y_m = T_before_after.y_m;
  const Eigen::Vector3d by_turn(0.5 * y_m, -0.5 * x_m, -1.0);
  Eigen::Matrix<double, 3, SystematicErrors::count> J;
  J.setZero();
  J.col(0) << -x_m, -y_m, 0.0;
  J.col(1) = seconds * by_turn;
  J.col(2) = x_m * by_turn;
  return J;
}

Eigen::Matrix<double, 2, SystematicErrors::count> derivative_without_errors(const core::Observation& observation) {
  Eigen::Matrix<double, 2, SystematicErrors::count> J;
  J.setZero();
  if (observation.kind == core::ObservationKind::range_bearing) {
    J(1, 3) = 1.0;
    J(0, 4) = 1.0;
  } else {
    const Eigen::Vector2d z = observation.z;
    J.col(3) << -z.y(), z.x();
    J.col(4) = z.normalized();
  }
  return J;
}

}  // namespace helixnav::supervisor
