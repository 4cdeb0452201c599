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

/// Positive semidefinite 3×3 by its principal minors, to round-off; no allocation.
bool is_covariance(const Eigen::Matrix3d& Q) {
  if (!Q.allFinite()) return false;
  const double scale = Q.cwiseAbs().maxCoeff();
  if (!std::isfinite(scale * scale * scale)) return false;  // its determinant says nothing
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
  if (!increment.allFinite()) refuse("odometry", odometry.t_ns, "the increment is not finite", increment);
  if (!is_covariance(odometry.covariance)) {
    refuse("odometry", odometry.t_ns, "the covariance is not symmetric positive semidefinite", odometry.covariance);
  }
}

void check(const Scan& scan) {
  const Eigen::Vector3d mounting = scan.T_robot_sensor.vector();
  if (!mounting.allFinite()) refuse("scan", scan.t_ns, "T_robot_sensor is not finite", mounting);
  const FieldOfView& view = scan.field_of_view;
  if (!is_in_order(view)) {
    refuse("scan", scan.t_ns, "the field of view is not finite or its bounds are not in order",
           Eigen::Vector4d(view.min_range_m, view.max_range_m, view.min_bearing_rad, view.max_bearing_rad));
  }
  for (std::size_t i = 0; i < scan.observations.size(); ++i) {
    try {
      check_observation(scan.observations[i]);
    } catch (const PreconditionError& error) {
      throw PreconditionError("scan at t_ns = " + std::to_string(scan.t_ns) + ": observation " + std::to_string(i) +
                              ": " + error.what());
    }
  }
}

void check(const AbsoluteFix& fix) {
  if (!fix.position_world_m.allFinite()) {
    refuse("fix", fix.t_ns, "the position is not finite", fix.position_world_m);
  }
  if (!fix.antenna_robot_m.allFinite()) refuse("fix", fix.t_ns, "the antenna is not finite", fix.antenna_robot_m);
  if (!is_positive_definite(fix.covariance_m2)) {
    refuse("fix", fix.t_ns, "the covariance is not symmetric positive definite", fix.covariance_m2);
  }
}

void check(const Event& event) {
  std::visit([](const auto& e) { check(e); }, event);
}

void check_order(Nanoseconds last_ns, Nanoseconds t_ns) {
  if (t_ns >= last_ns) return;
  throw PreconditionError("an event at t_ns = " + std::to_string(t_ns) +
                          " comes after one at t_ns = " + std::to_string(last_ns));
}

}  // namespace helixnav::core
