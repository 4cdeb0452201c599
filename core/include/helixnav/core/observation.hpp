// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "helixnav/core/appearance.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::core {

/// What a sensor measures of one landmark, in the frame of the sensor.
enum class ObservationKind {
  range_bearing,  ///< z = (range [m], bearing [rad]), bearing counter-clockwise from the sensor's x axis
  cartesian,      ///< z = (x, y) [m]
  bearing,        ///< z = (bearing [rad])
  range,          ///< z = (range [m])
};

constexpr int dimension(ObservationKind kind) {
  return kind == ObservationKind::range_bearing || kind == ObservationKind::cartesian ? 2 : 1;
}

/// Vectors and matrices of one observation: one or two rows, never on the heap.
using ObsVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2, 1>;
using ObsMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2, 2>;
using ObsByPose = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 2, 3>;
using ObsByPoint = Eigen::Matrix<double, Eigen::Dynamic, 2, 0, 2, 2>;

/// One measured landmark: z with its noise covariance R (d×d, d = dimension(kind)), and what it looks like.
struct Observation {
  ObservationKind kind = ObservationKind::range_bearing;
  ObsVector z;
  ObsMatrix R;
  Appearance appearance = {};
};

Observation make_range_bearing(double range_m, double bearing_rad, double sigma_range_m, double sigma_bearing_rad);
Observation make_cartesian(const Eigen::Vector2d& point_m, const Eigen::Matrix2d& covariance_m2);
Observation make_bearing(double bearing_rad, double sigma_bearing_rad);
Observation make_range(double range_m, double sigma_range_m);

/// ẑ = h(T_world_robot ∘ T_robot_sensor, m) and its derivatives: H_pose (d×3, by x, y, heading of the robot) and
/// H_landmark (d×2, by the landmark's x and y in the world).
struct PredictedObservation {
  ObsVector z_hat;
  ObsByPose H_pose;
  ObsByPoint H_landmark;
};

/// Predicts the observation of a landmark. Bearings are in (-π, π]. Throws NumericalError when the landmark is at the
/// sensor itself (closer than 1 µm), where bearing and range have no derivative.
/// Source: dlr_kurlbaum2009 eq (8)-(10) for cartesian; polar form of the same. Test: core/observation_test.cpp (Jacobians
/// against central differences).
PredictedObservation predict_observation(ObservationKind kind, const Pose2& T_world_robot, const Pose2& T_robot_sensor,
                                         const Eigen::Vector2d& landmark_world_m);

/// ν = z − ẑ with its bearing in (-π, π]. Test: core/observation_test.cpp.
ObsVector innovation(ObservationKind kind, const ObsVector& z, const ObsVector& z_hat);

/// The landmark m = g(T_world_robot, z) of an observation, with derivatives G_pose (2×3) and G_z (2×2).
struct LocatedLandmark {
  Eigen::Vector2d point_world_m;
  Eigen::Matrix<double, 2, 3> G_pose;
  Eigen::Matrix2d G_z;
};

/// Inverse of predict_observation for the kinds with two rows; PreconditionError for bearing and range alone, which do
/// not fix a point. Test: core/observation_test.cpp.
LocatedLandmark locate_landmark(const Observation& observation, const Pose2& T_world_robot,
                                const Pose2& T_robot_sensor);

/// Throws PreconditionError unless z is finite, ranges are positive, bearings are within ±2π, shapes fit the kind, R is
/// symmetric positive definite, a class error is in (0, 1) and a size and its deviation are positive. No allocation
/// unless it throws. Test: core/observation_test.cpp.
void check_observation(const Observation& observation);

}  // namespace helixnav::core
