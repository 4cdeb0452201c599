// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/check_event.hpp"

#include <cmath>
#include <sstream>
#include <string>
#include <variant>

#include <Eigen/LU>

#include "helixnav/core/errors.hpp"

namespace helixnav::core {
namespace {

constexpr double most_m = 1e8;  // northings of UTM go up to 1e7
constexpr double most_heading_rad = 1e6;
constexpr double most_covariance = most_m * most_m;

bool is_plausible(const Eigen::Vector2d& lengths_m) {
  return lengths_m.allFinite() && lengths_m.cwiseAbs().maxCoeff() <= most_m;
}

bool is_plausible(const Pose2& pose) {
  return is_plausible(pose.position_m()) && std::abs(pose.heading_rad) <= most_heading_rad;  // false for NaN
}

template <class Matrix>
bool is_covariance_plausible(const Matrix& C) {
  return C.cwiseAbs().maxCoeff() <= most_covariance;
}

/// Bearings are bounded by check_observation.
bool is_plausible(const Observation& observation) {
  return observation.z.cwiseAbs().maxCoeff() <= most_m && is_covariance_plausible(observation.R);
}

/// Positive semidefinite 3×3 by its principal minors, to round-off; no allocation.
bool is_covariance(const Eigen::Matrix3d& Q) {
  if (!Q.allFinite()) return false;
  const double scale = Q.cwiseAbs().maxCoeff();
  const double tiny = 1e-9 * scale;
  if ((Q - Q.transpose()).cwiseAbs().maxCoeff() > tiny || Q.diagonal().minCoeff() < -tiny) return false;
  const auto minor = [&](int i, int j) { return Q(i, i) * Q(j, j) - Q(i, j) * Q(j, i); };
  const double least = -tiny * scale;
  return minor(0, 1) >= least && minor(0, 2) >= least && minor(1, 2) >= least && Q.determinant() >= least * scale;
}

bool is_positive_definite(const Eigen::Matrix2d& C) {
  if (!C.allFinite() || !(C(0, 0) > 0.0)) return false;
  const double scale = C.cwiseAbs().maxCoeff();
  return std::abs(C(0, 1) - C(1, 0)) <= 1e-9 * scale && C(0, 0) * C(1, 1) - C(0, 1) * C(1, 0) > 0.0;
}

bool is_in_order(const FieldOfView& view) {
  return std::isfinite(view.min_range_m) && view.min_range_m >= 0.0 && view.max_range_m >= 0.0 &&
         (view.max_range_m >= view.min_range_m || view.max_range_m == 0.0) && std::isfinite(view.min_bearing_rad) &&
         std::isfinite(view.max_bearing_rad) && view.min_bearing_rad <= view.max_bearing_rad;
}

template <class Values>
[[noreturn]] void refuse(const char* event, Nanoseconds t_ns, const char* problem, const Values& values) {
  const Eigen::IOFormat on_one_line(6, Eigen::DontAlignCols, ", ", "; ");
  std::ostringstream message;
  message << event << " at t_ns = " << t_ns << ": " << problem << ": [" << values.format(on_one_line) << "]";
  throw PreconditionError(message.str());
}

}  // namespace

void check(const Odometry& odometry) {
  const Eigen::Vector3d increment = odometry.T_before_after.vector();
  if (!is_plausible(odometry.T_before_after)) {
    refuse("odometry", odometry.t_ns, "the increment is not finite, or beyond 1e8 m or 1e6 rad", increment);
  }
  if (!is_covariance_plausible(odometry.covariance)) {
    refuse("odometry", odometry.t_ns, "the covariance is not finite, or beyond 1e16", odometry.covariance);
  }
  if (!is_covariance(odometry.covariance)) {
    refuse("odometry", odometry.t_ns, "the covariance is not symmetric positive semidefinite", odometry.covariance);
  }
}

void check(const Scan& scan) {
  const Eigen::Vector3d mounting = scan.T_robot_sensor.vector();
  if (!is_plausible(scan.T_robot_sensor)) {
    refuse("scan", scan.t_ns, "T_robot_sensor is not finite, or beyond 1e8 m or 1e6 rad", mounting);
  }
  const FieldOfView& view = scan.field_of_view;
  if (!is_in_order(view)) {
    refuse("scan", scan.t_ns, "the field of view is not finite or its bounds are not in order",
           Eigen::Vector4d(view.min_range_m, view.max_range_m, view.min_bearing_rad, view.max_bearing_rad));
  }
  for (std::size_t i = 0; i < scan.observations.size(); ++i) {
    try {
      check_observation(scan.observations[i]);
      if (!is_plausible(scan.observations[i])) throw PreconditionError("beyond 1e8 m, or its R beyond 1e16");
    } catch (const PreconditionError& error) {
      throw PreconditionError("scan at t_ns = " + std::to_string(scan.t_ns) + ": observation " + std::to_string(i) +
                              ": " + error.what());
    }
  }
}

void check(const AbsoluteFix& fix) {
  if (!is_plausible(fix.position_world_m)) {
    refuse("fix", fix.t_ns, "the position is not finite, or beyond 1e8 m", fix.position_world_m);
  }
  if (!is_plausible(fix.antenna_robot_m)) {
    refuse("fix", fix.t_ns, "the antenna is not finite, or beyond 1e8 m", fix.antenna_robot_m);
  }
  if (!is_covariance_plausible(fix.covariance_m2) || !is_positive_definite(fix.covariance_m2)) {
    refuse("fix", fix.t_ns, "the covariance is not symmetric positive definite, or beyond 1e16", fix.covariance_m2);
  }
}

void check(const Event& event) {
  std::visit([](const auto& e) { check(e); }, event);
}

void check_start(const PoseGaussian& start) {
  if (!is_plausible(start.mean)) throw PreconditionError("pose: the mean is not finite, or beyond 1e8 m or 1e6 rad");
  if (!start.covariance.allFinite() || !is_covariance_plausible(start.covariance)) {
    throw PreconditionError("pose: the covariance is not finite, or beyond 1e16");
  }
  if (!is_symmetric_positive_semidefinite(start.covariance)) {
    throw PreconditionError("pose: the covariance is not symmetric positive semidefinite");
  }
}

void check_order(Nanoseconds last_ns, Nanoseconds t_ns) {
  if (t_ns >= last_ns) return;
  throw PreconditionError("an event at t_ns = " + std::to_string(t_ns) +
                          " comes after one at t_ns = " + std::to_string(last_ns));
}

}  // namespace helixnav::core
