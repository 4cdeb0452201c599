// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/core/se2.hpp"
#include "landmark_record.hpp"

namespace helixnav::fastslam {

using Matrix23 = Eigen::Matrix<double, 2, 3>;

/// An observation prepared for thousands of particles: the only trigonometry left is that of the particle's heading.
struct PreparedObservation {
  bool polar = true;                ///< range and bearing, else cartesian
  Eigen::Vector2d point_robot_m;    ///< what was seen, in the frame of the robot
  Eigen::Vector2d direction_robot;  ///< unit vector from the sensor to it (polar)
  double range_m = 0.0;             ///< from the sensor
  Eigen::Vector2d z_m;              ///< cartesian: in the frame of the sensor
  Eigen::Matrix2d R;
  double noise_m2 = 0.0;  ///< trace of the noise, in the plane
  double arm_m = 0.0;     ///< from the robot's reference point to what was seen
};

struct PreparedScan {
  Eigen::Vector2d sensor_robot_m;  ///< where the sensor is on the robot
  double sensor_heading_rad = 0.0;
  double c = 1.0, s = 0.0;  ///< of sensor_heading_rad
  core::FieldOfView view;
  std::vector<PreparedObservation> observations;
};

inline PreparedScan prepare(const core::Scan& scan) {
  PreparedScan out;
  out.sensor_robot_m = scan.T_robot_sensor.position_m();
  out.sensor_heading_rad = scan.T_robot_sensor.heading_rad;
  out.c = std::cos(out.sensor_heading_rad);
  out.s = std::sin(out.sensor_heading_rad);
  out.view = scan.field_of_view;
  const Eigen::Matrix2d R_robot_sensor = core::rotation(out.sensor_heading_rad);
  for (const core::Observation& observation : scan.observations) {
    PreparedObservation p;
    p.polar = observation.kind == core::ObservationKind::range_bearing;
    p.R = observation.R;
    p.z_m = observation.z;
    if (p.polar) {
      p.range_m = observation.z[0];
      p.direction_robot = R_robot_sensor * Eigen::Vector2d(std::cos(observation.z[1]), std::sin(observation.z[1]));
      p.point_robot_m = out.sensor_robot_m + p.range_m * p.direction_robot;
      p.noise_m2 = p.R(0, 0) + p.range_m * p.range_m * p.R(1, 1);
    } else {
      p.range_m = p.z_m.norm();
      p.direction_robot = R_robot_sensor * Eigen::Vector2d(1.0, 0.0);
      p.point_robot_m = out.sensor_robot_m + R_robot_sensor * p.z_m;
      p.noise_m2 = p.R.trace();
    }
    p.arm_m = p.point_robot_m.norm();
    out.observations.push_back(p);
  }
  return out;
}

/// atan2(y, x), by its series where the angle is small: as exact, and several times faster.
inline double angle_of(double y, double x) {
  if (!(std::abs(y) < 0.1 * x)) return std::atan2(y, x);
  const double t = y / x, q = t * t;
  const double tail = 1.0 / 9.0 - q * (1.0 / 11.0 - q * (1.0 / 13.0 - q / 15.0));
  return t * (1.0 - q * (1.0 / 3.0 - q * (1.0 / 5.0 - q * (1.0 / 7.0 - q * tail))));
}

/// A pose with the sine and cosine of its heading.
struct TurnedPose {
  double x_m = 0.0, y_m = 0.0, c = 1.0, s = 0.0;

  TurnedPose() = default;
  explicit TurnedPose(const Eigen::Vector3d& pose)
      : x_m(pose[0]), y_m(pose[1]), c(std::cos(pose[2])), s(std::sin(pose[2])) {}
  Eigen::Vector2d turn(const Eigen::Vector2d& v) const { return {c * v.x() - s * v.y(), s * v.x() + c * v.y()}; }
  Eigen::Vector2d place(const Eigen::Vector2d& v) const { return turn(v) + Eigen::Vector2d(x_m, y_m); }
};

/// ν = z − h(pose, m), and derivatives of h: H_pose by (x, y, heading), H_point by the landmark.
struct Pair {
  Eigen::Vector2d nu;
  Matrix23 H_pose;
  Eigen::Matrix2d H_point;
};

/// Same as core::predict_observation with core::innovation; a landmark at the sensor itself is taken 1 µm away.
/// Test: fastslam/scan_model_test.cpp.
inline Pair compare(const PreparedScan& scan, const PreparedObservation& z, const TurnedPose& pose,
                    const Eigen::Vector2d& landmark_m) {
  Pair out;
  const Eigen::Vector2d arm = pose.turn(scan.sensor_robot_m);
  const double dx = landmark_m.x() - pose.x_m - arm.x(), dy = landmark_m.y() - pose.y_m - arm.y();
  if (z.polar) {
    const double q = std::max(dx * dx + dy * dy, 1e-12), r = std::sqrt(q);
    const Eigen::Vector2d to = pose.turn(z.direction_robot);
    out.nu << z.range_m - r, angle_of(dx * to.y() - dy * to.x(), dx * to.x() + dy * to.y());
    out.H_point << dx / r, dy / r, -dy / q, dx / q;
    out.H_pose.leftCols<2>() = -out.H_point;
    out.H_pose(0, 2) = (dx * arm.y() - dy * arm.x()) / r;
    out.H_pose(1, 2) = -1.0 - (dx * arm.x() + dy * arm.y()) / q;
  } else {
    const double c = pose.c * scan.c - pose.s * scan.s, s = pose.s * scan.c + pose.c * scan.s;
    out.nu << z.z_m.x() - (c * dx + s * dy), z.z_m.y() - (c * dy - s * dx);
    out.H_point << c, s, -s, c;
    out.H_pose.leftCols<2>() = -out.H_point;
    const double px = landmark_m.x() - pose.x_m, py = landmark_m.y() - pose.y_m;
    out.H_pose(0, 2) = c * py - s * px;
    out.H_pose(1, 2) = -s * py - c * px;
  }
  return out;
}

/// Derivative of the landmark's place by the observation, at the pose (2×2).
inline Eigen::Matrix2d place_by_observation(const PreparedScan& scan, const PreparedObservation& z,
                                            const TurnedPose& pose) {
  Eigen::Matrix2d G;
  if (z.polar) {
    const Eigen::Vector2d to = pose.turn(z.direction_robot);
    G << to.x(), -z.range_m * to.y(), to.y(), z.range_m * to.x();
  } else {
    const double c = pose.c * scan.c - pose.s * scan.s, s = pose.s * scan.c + pose.c * scan.s;
    G << c, -s, s, c;
  }
  return G;
}

/// Which landmarks a sensor should see, without an arctangent. `shrink` < 1 takes off the far end, `edge_rad` the sides.
class ViewTest {
 public:
  ViewTest(const core::FieldOfView& view, double shrink, double edge_rad)
      : bounded_(std::isfinite(view.max_range_m)),
        least_m2_(view.min_range_m * view.min_range_m),
        most_m2_(shrink * shrink * view.max_range_m * view.max_range_m),
        width_rad_(view.max_bearing_rad - view.min_bearing_rad - 2.0 * edge_rad) {
    const double from = view.min_bearing_rad + edge_rad, to = view.max_bearing_rad - edge_rad;
    all_round_ = view.max_bearing_rad - view.min_bearing_rad > 2.0 * core::pi - 1e-6;
    from_ << std::cos(from), std::sin(from);
    to_ << std::cos(to), std::sin(to);
  }
  bool bounded() const { return bounded_; }

  /// The point in the frame of the sensor.
  bool sees(double x_m, double y_m) const {
    const double q = x_m * x_m + y_m * y_m;
    if (q < least_m2_ || q > most_m2_ || width_rad_ <= 0.0) return false;
    if (all_round_) return true;
    const bool after = from_.x() * y_m - from_.y() * x_m >= 0.0, before = x_m * to_.y() - y_m * to_.x() >= 0.0;
    return width_rad_ <= core::pi ? after && before : after || before;
  }

 private:
  bool bounded_, all_round_ = false;
  double least_m2_, most_m2_, width_rad_;
  Eigen::Vector2d from_, to_;
};

/// The point in the frame of the sensor.
inline Eigen::Vector2d in_sensor(const PreparedScan& scan, const TurnedPose& pose, const Eigen::Vector2d& point_m) {
  const double dx = point_m.x() - pose.x_m, dy = point_m.y() - pose.y_m;
  const double rx = pose.c * dx + pose.s * dy - scan.sensor_robot_m.x();
  const double ry = pose.c * dy - pose.s * dx - scan.sensor_robot_m.y();
  return {scan.c * rx + scan.s * ry, scan.c * ry - scan.s * rx};
}

}  // namespace helixnav::fastslam
