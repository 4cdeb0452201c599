// SPDX-License-Identifier: BSD-3-Clause
#include "sensor_rows.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "helixnav/core/errors.hpp"

namespace helixnav::logs {
namespace {

std::string where(const Vehicle& vehicle) { return vehicle.path.empty() ? "no vehicle.toml" : vehicle.path; }

double given_variance(const std::optional<double>& sigma, const SensorModel& sensor, const Vehicle& vehicle,
                      const char* key) {
  if (sigma) return *sigma * *sigma;
  throw core::InputError(where(vehicle) +
                         ": no noise of a detection is given: neither a column of detections.csv nor " + key +
                         " in section [[sensor]]" + (sensor.name.empty() ? "" : " of '" + sensor.name + "'") +
                         "; 'helixnav new-vehicle' writes an example");
}

core::Appearance appearance_of(const OwnDetection& row, const SensorModel& sensor, const Vehicle& vehicle) {
  core::Appearance seen;
  seen.name = row.class_name;
  if (sensor.class_error) seen.class_error = *sensor.class_error;
  if (!(row.size_m > 0.0)) return seen;
  seen.size_m = row.size_m;
  seen.sigma_size_m = row.sigma_size_m > 0.0
                          ? row.sigma_size_m
                          : std::sqrt(given_variance(sensor.sigma_size_m, sensor, vehicle, "sigma_size_m"));
  return seen;
}

/// For a recorded range.
double true_range_m(double recorded_m, const SensorModel& sensor) {
  constexpr double least_m = 1e-3;
  return std::max(recorded_m / sensor.range_scale + sensor.range_offset_m, std::min(recorded_m, least_m));
}

/// For a recorded point.
Eigen::Vector2d true_point_m(const Eigen::Vector2d& recorded_m, const SensorModel& sensor) {
  const double range_m = recorded_m.norm();
  if (range_m == 0.0 || sensor.range_offset_m == 0.0) return recorded_m / sensor.range_scale;
  return recorded_m * (true_range_m(range_m, sensor) / range_m);
}

}  // namespace

SensorModel sensor_called(const std::string& name, const std::string& log, const Vehicle& vehicle) {
  const SensorModel* found = nullptr;
  std::string known;
  for (const SensorModel& sensor : vehicle.sensors) {
    if (sensor.name == name || (vehicle.sensors.size() == 1 && (name.empty() || sensor.name.empty()))) found = &sensor;
    known += (known.empty() ? "" : ", ") + sensor.name;
  }
  if (found == nullptr && name.empty() && !vehicle.sensors.empty()) {
    throw core::InputError(log +
                           ": the column sensor of the detections is missing, or empty in a row, and the vehicle (" +
                           where(vehicle) + ") has the sensors " + known + ": expected one of them in each row");
  }
  if (found == nullptr && !vehicle.sensors.empty()) {
    throw core::InputError(where(vehicle) + ": no [[sensor]] is called '" + name + "' as in the column sensor of " +
                           log + "; there are: " + known);
  }
  return found == nullptr ? SensorModel() : *found;
}

core::Observation observation_of(const OwnDetection& row, const SensorModel& sensor, const Vehicle& vehicle) {
  const auto range_variance = [&] {
    return row.R[0] > 0.0 ? row.R[0] : given_variance(sensor.sigma_range_m, sensor, vehicle, "sigma_range_m");
  };
  const auto bearing_variance = [&](double own_variance) {
    return own_variance > 0.0 ? own_variance
                              : given_variance(sensor.sigma_bearing_rad, sensor, vehicle, "sigma_bearing_deg");
  };
  core::Observation observation;
  if (row.kind == OwnDetection::Kind::range_bearing) {
    observation = core::make_range_bearing(true_range_m(row.z[0], sensor), row.z[1], std::sqrt(range_variance()),
                                           std::sqrt(bearing_variance(row.R[2])));
  } else if (row.kind == OwnDetection::Kind::range) {
    observation = core::make_range(true_range_m(row.z[0], sensor), std::sqrt(range_variance()));
  } else if (row.kind == OwnDetection::Kind::bearing) {
    observation = core::make_bearing(row.z[0], std::sqrt(bearing_variance(row.R[0])));
  } else {
    Eigen::Matrix2d R;
    R << row.R[0], row.R[1], row.R[1], row.R[2];
    if (!(row.R[0] > 0.0))
      R = given_variance(sensor.sigma_point_m, sensor, vehicle, "sigma_point_m") * Eigen::Matrix2d::Identity();
    observation = core::make_cartesian(true_point_m({row.z[0], row.z[1]}, sensor), R);
  }
  observation.R *= sensor.noise_scale * sensor.noise_scale;
  observation.appearance = appearance_of(row, sensor, vehicle);
  return observation;
}

}  // namespace helixnav::logs
