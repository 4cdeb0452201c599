// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/observation.hpp"

#include <cmath>
#include <sstream>

#include "helixnav/core/errors.hpp"

namespace helixnav::core {
namespace {

constexpr double nearest_range_m = 1e-6;

/// Landmark in the sensor frame, with derivatives by the robot's pose (2×3) and by the landmark (2×2).
struct RelativePoint {
  Eigen::Vector2d point_sensor_m;
  Eigen::Matrix<double, 2, 3> J_pose;
  Eigen::Matrix2d J_landmark;
};

RelativePoint relative_point(const Pose2& T_world_robot, const Pose2& T_robot_sensor,
                             const Eigen::Vector2d& landmark_world_m) {
  const Eigen::Matrix2d R_robot_world = rotation(T_world_robot.heading_rad).transpose();
  const Eigen::Matrix2d R_sensor_robot = rotation(T_robot_sensor.heading_rad).transpose();
  const Eigen::Vector2d point_robot_m = R_robot_world * (landmark_world_m - T_world_robot.position_m());

  RelativePoint relative;
  relative.point_sensor_m = R_sensor_robot * (point_robot_m - T_robot_sensor.position_m());
  relative.J_landmark = R_sensor_robot * R_robot_world;
  relative.J_pose.leftCols<2>() = -relative.J_landmark;
  // d(R(-heading) p)/d heading = -J R(-heading) p with J the quarter turn.
  relative.J_pose.col(2) = R_sensor_robot * Eigen::Vector2d(point_robot_m.y(), -point_robot_m.x());
  return relative;
}

/// Polar coordinates of a point and their derivative by the point.
struct Polar {
  double range_m;
  double bearing_rad;
  Eigen::RowVector2d J_range;
  Eigen::RowVector2d J_bearing;
};

Polar polar(const Eigen::Vector2d& point_m) {
  const double range_m = point_m.norm();
  if (!(range_m > nearest_range_m)) {
    throw NumericalError(
        "predict_observation: the landmark stands at the sensor; bearing and range have no derivative");
  }
  return {range_m, std::atan2(point_m.y(), point_m.x()), point_m.transpose() / range_m,
          Eigen::RowVector2d(-point_m.y(), point_m.x()) / (range_m * range_m)};
}

Observation make_scalar(ObservationKind kind, double value, double sigma) {
  Observation observation;
  observation.kind = kind;
  observation.z = ObsVector::Constant(1, value);
  observation.R = ObsMatrix::Constant(1, 1, sigma * sigma);
  return observation;
}

bool has_range(ObservationKind kind) {
  return kind == ObservationKind::range_bearing || kind == ObservationKind::range;
}

/// Beyond ±2π: such a bearing is not in radians.
bool has_impossible_bearing(const Observation& observation) {
  constexpr double most_rad = 2.0 * pi;
  if (observation.kind == ObservationKind::range_bearing) return std::abs(observation.z[1]) > most_rad;
  return observation.kind == ObservationKind::bearing && std::abs(observation.z[0]) > most_rad;
}

/// is_symmetric_positive_definite for one or two rows, without the heap: every observation of every scan is checked.
bool is_small_spd(const ObsMatrix& R) {
  if (!R.allFinite() || !(R(0, 0) > 0.0)) return false;
  if (R.rows() == 1) return true;
  const double scale = R.cwiseAbs().maxCoeff();
  return std::abs(R(0, 1) - R(1, 0)) <= 1e-9 * scale && R(0, 0) * R(1, 1) - R(0, 1) * R(1, 0) > 0.0;
}

/// Smaller than any length, so that its square is a variance.
bool is_usable(const Appearance& seen) {
  constexpr double least_m = 1e-9;
  constexpr double most_m = 1e6;
  const bool sized = seen.size_m == 0.0 || (seen.size_m >= least_m && seen.size_m <= most_m &&
                                            seen.sigma_size_m >= least_m && seen.sigma_size_m <= most_m);
  return sized && (seen.name.empty() || (seen.class_error >= least_m && seen.class_error <= 1.0 - least_m));
}

[[noreturn]] void refuse(const Observation& observation, const char* problem) {
  std::ostringstream message;
  message << "observation: " << problem << "; z = [" << observation.z.transpose() << "], R = ["
          << observation.R.reshaped().transpose() << "]";
  throw PreconditionError(message.str());
}

}  // namespace

Observation make_range_bearing(double range_m, double bearing_rad, double sigma_range_m, double sigma_bearing_rad) {
  Observation observation;
  observation.kind = ObservationKind::range_bearing;
  observation.z = Eigen::Vector2d(range_m, bearing_rad);
  observation.R = Eigen::Vector2d(sigma_range_m * sigma_range_m, sigma_bearing_rad * sigma_bearing_rad).asDiagonal();
  return observation;
}

Observation make_cartesian(const Eigen::Vector2d& point_m, const Eigen::Matrix2d& covariance_m2) {
  Observation observation;
  observation.kind = ObservationKind::cartesian;
  observation.z = point_m;
  observation.R = covariance_m2;
  return observation;
}

Observation make_bearing(double bearing_rad, double sigma_bearing_rad) {
  return make_scalar(ObservationKind::bearing, bearing_rad, sigma_bearing_rad);
}

Observation make_range(double range_m, double sigma_range_m) {
  return make_scalar(ObservationKind::range, range_m, sigma_range_m);
}

PredictedObservation predict_observation(ObservationKind kind, const Pose2& T_world_robot, const Pose2& T_robot_sensor,
                                         const Eigen::Vector2d& landmark_world_m) {
  const RelativePoint relative = relative_point(T_world_robot, T_robot_sensor, landmark_world_m);
  PredictedObservation predicted;
  if (kind == ObservationKind::cartesian) {
    predicted.z_hat = relative.point_sensor_m;
    predicted.H_pose = relative.J_pose;
    predicted.H_landmark = relative.J_landmark;
    return predicted;
  }
  const Polar p = polar(relative.point_sensor_m);
  ObsByPoint J_point;
  switch (kind) {
    case ObservationKind::range_bearing:
      predicted.z_hat = Eigen::Vector2d(p.range_m, p.bearing_rad);
      J_point.resize(2, 2);
      J_point << p.J_range, p.J_bearing;
      break;
    case ObservationKind::bearing:
      predicted.z_hat = ObsVector::Constant(1, p.bearing_rad);
      J_point = p.J_bearing;
      break;
    default:  // range
      predicted.z_hat = ObsVector::Constant(1, p.range_m);
      J_point = p.J_range;
      break;
  }
  predicted.H_pose = J_point * relative.J_pose;
  predicted.H_landmark = J_point * relative.J_landmark;
  return predicted;
}

ObsVector innovation(ObservationKind kind, const ObsVector& z, const ObsVector& z_hat) {
  ObsVector nu = z - z_hat;
  if (kind == ObservationKind::range_bearing) nu[1] = wrap_to_pi(nu[1]);
  if (kind == ObservationKind::bearing) nu[0] = wrap_to_pi(nu[0]);
  return nu;
}

LocatedLandmark locate_landmark(const Observation& observation, const Pose2& T_world_robot,
                                const Pose2& T_robot_sensor) {
  if (dimension(observation.kind) != 2) {
    throw PreconditionError("locate_landmark: a bearing or a range alone does not fix a point");
  }
  Eigen::Vector2d point_sensor_m = observation.z;
  Eigen::Matrix2d J_z = Eigen::Matrix2d::Identity();
  if (observation.kind == ObservationKind::range_bearing) {
    const double range_m = observation.z[0];
    const double c = std::cos(observation.z[1]);
    const double s = std::sin(observation.z[1]);
    point_sensor_m << range_m * c, range_m * s;
    J_z << c, -range_m * s, s, range_m * c;
  }
  const Pose2 T_world_sensor = compose(T_world_robot, T_robot_sensor);
  LocatedLandmark located;
  located.point_world_m = transform(T_world_sensor, point_sensor_m);
  const Eigen::Vector2d arm_world_m = located.point_world_m - T_world_robot.position_m();
  located.G_pose.leftCols<2>().setIdentity();
  located.G_pose.col(2) << -arm_world_m.y(), arm_world_m.x();
  located.G_z = rotation(T_world_sensor.heading_rad) * J_z;
  return located;
}

void check_observation(const Observation& observation) {
  const int d = dimension(observation.kind);
  if (observation.z.size() != d || observation.R.rows() != d || observation.R.cols() != d) {
    refuse(observation, "z and R must have as many rows as the kind");
  } else if (!observation.z.allFinite()) {
    refuse(observation, "z is not finite");
  } else if (has_range(observation.kind) && observation.z[0] <= 0.0) {
    refuse(observation, "the range must be positive");
  } else if (has_impossible_bearing(observation)) {
    refuse(observation, "the bearing must lie within ±2π");
  } else if (!is_small_spd(observation.R)) {
    refuse(observation, "R is not symmetric positive definite");
  } else if (!is_usable(observation.appearance)) {
    refuse(observation, "a class needs a class error in (0, 1), a size itself and its deviation above 0");
  }
}

}  // namespace helixnav::core
