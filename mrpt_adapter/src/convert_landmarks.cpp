// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/poses/CPose3D.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/observation.hpp"
#include "helixnav/mrpt_adapter/conversions.hpp"
#include "matrices.hpp"

namespace helixnav::mrpt_adapter {
namespace {

using mrpt::obs::CObservationBearingRange;

/// Noise of (range, yaw, pitch) of measurements that bring no covariance of their own.
Eigen::Matrix3d common_noise(const CObservationBearingRange& observation, const MapBuilderOptions& options) {
  const auto either = [](double chosen, float own) { return chosen > 0.0 ? chosen : static_cast<double>(own); };
  const double sigma_range_m = either(options.std_sensor_range, observation.sensor_std_range);
  const double sigma_yaw_rad = either(options.std_sensor_yaw_rad, observation.sensor_std_yaw);
  if (!(sigma_range_m > 0.0) || !(sigma_yaw_rad > 0.0)) {
    throw core::InputError("CObservationBearingRange \"" + observation.sensorLabel +
                           "\": it says nothing of its noise; set std_sensor_range and std_sensor_yaw_deg");
  }
  const double sigma_pitch_rad = observation.sensor_std_pitch;
  return Eigen::Vector3d(sigma_range_m * sigma_range_m, sigma_yaw_rad * sigma_yaw_rad,
                         sigma_pitch_rad * sigma_pitch_rad)
      .asDiagonal();
}

/// A measurement with a pitch, in the sensor's plane.
core::Observation project(const CObservationBearingRange::TMeasurement& measured, const Eigen::Matrix3d& noise) {
  const double range_m = measured.range;
  const double cosine = std::cos(static_cast<double>(measured.pitch));
  const double sine = std::sin(static_cast<double>(measured.pitch));
  Eigen::Matrix<double, 2, 3> J;
  J << cosine, 0.0, -range_m * sine, 0.0, 1.0, 0.0;
  core::Observation observation;
  observation.kind = core::ObservationKind::range_bearing;
  observation.z = Eigen::Vector2d(range_m * cosine, core::wrap_to_pi(measured.yaw));
  observation.R = J * noise * J.transpose();
  return observation;
}

/// What is wrong with a measurement; empty when nothing is.
std::string fault_of(const core::Observation& observation) {
  if (!observation.z.allFinite()) return "range, yaw or pitch is not finite";
  if (!(observation.z(0) > 0.0)) return "its range is not positive";
  if (!core::is_symmetric_positive_definite(observation.R)) return "its covariance is not symmetric positive definite";
  return {};
}

core::FieldOfView field_of_view(const CObservationBearingRange& observation, const MapBuilderOptions& options) {
  core::FieldOfView view;
  view.min_range_m = std::fmax(0.0, observation.minSensorDistance);
  view.max_range_m = observation.maxSensorDistance > 0.0F ? static_cast<double>(observation.maxSensorDistance)
                                                          : std::numeric_limits<double>::infinity();
  if (options.max_sensor_range > 0.0) {
    if (std::isfinite(view.max_range_m)) view.reach_m = view.max_range_m;
    view.max_range_m = options.max_sensor_range;
  }
  const double half_rad = static_cast<double>(observation.fieldOfView_yaw) / 2.0;
  constexpr double of_a_float = 1e-6;  // 2π in single precision, or 360° in it, is a full circle
  if (half_rad > 0.0 && half_rad < core::pi - of_a_float) {
    view.min_bearing_rad = -half_rad;
    view.max_bearing_rad = half_rad;
  }
  return view;
}

}  // namespace

core::Pose2 planar_pose_of(const mrpt::poses::CPose3D& pose, const std::string& whose) {
  constexpr double level_rad = 1e-3;
  const bool finite = std::isfinite(pose.x()) && std::isfinite(pose.y()) && std::isfinite(pose.yaw());
  if (!finite || !(std::abs(pose.pitch()) < level_rad) || !(std::abs(pose.roll()) < level_rad)) {
    throw core::InputError(whose + ": the sensor must look along the plane, its pose on the robot is " +
                           pose.asString());
  }
  return {pose.x(), pose.y(), pose.yaw()};
}

NamedScan scan_of(const CObservationBearingRange& observation, const MapBuilderOptions& options) {
  const std::string whose = "CObservationBearingRange \"" + observation.sensorLabel + "\"";
  NamedScan result;
  result.has_time = time_of(observation).has_value();
  result.scan.t_ns = time_of(observation).value_or(0);
  result.scan.T_robot_sensor = planar_pose_of(observation.sensorLocationOnRobot, whose);
  result.scan.field_of_view = field_of_view(observation, options);
  Eigen::Matrix3d noise = Eigen::Matrix3d::Zero();
  if (!observation.validCovariances && !observation.sensedData.empty()) noise = common_noise(observation, options);
  for (std::size_t i = 0; i < observation.sensedData.size(); ++i) {
    const CObservationBearingRange::TMeasurement& measured = observation.sensedData[i];
    if (observation.validCovariances) noise = eigen_of(measured.covariance);
    core::Observation seen = project(measured, noise);
    const std::string fault = fault_of(seen);
    if (!fault.empty()) {
      std::string sentence = whose;
      sentence.append(", measurement ").append(std::to_string(i)).append(" left out: ").append(fault);
      result.dropped.push_back(std::move(sentence));
      continue;
    }
    result.scan.observations.push_back(std::move(seen));
    result.identities.push_back(measured.landmarkID < 0 ? -1 : measured.landmarkID);
    result.measurements.push_back(i);
  }
  return result;
}

}  // namespace helixnav::mrpt_adapter
