// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_of_log.hpp"

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "helixnav/core/errors.hpp"
#include "vehicle_option.hpp"

namespace helixnav::apps {
namespace {

void refuse(bool has, const logs::Vehicle& vehicle, const char* what) {
  if (has) throw core::InputError(vehicle.path + ": " + what + " is nothing that the vehicle of this log has");
}

const logs::SensorModel& only_sensor(const logs::Vehicle& vehicle) {
  if (vehicle.sensors.size() == 1) return vehicle.sensors.front();
  throw core::InputError(vehicle.path + ": a log of this format has one sensor; expected one [[sensor]], found " +
                         std::to_string(vehicle.sensors.size()));
}

bool is_mounted(const logs::SensorModel& sensor) {
  return !sensor.T_vehicle_sensor.vector().isZero(0.0) || sensor.delay_s != 0.0;
}

void refuse_of_truck(const logs::Vehicle& vehicle, const logs::SensorModel& sensor) {
  const logs::OdometryModel& odometry = vehicle.odometry;
  refuse(odometry.turn_scale != 1.0 || odometry.turn_bias_radps != 0.0, vehicle, "a scale or bias of turns");
  refuse(odometry.track_m.has_value(), vehicle, "odometry.track_m");
  refuse(!odometry.T_vehicle_odometry.vector().isZero(0.0), vehicle, "another place of the odometry");
  refuse(odometry.sigma_along_m_per_sqrt_m || odometry.sigma_heading_rad_per_sqrt_m ||
             odometry.sigma_heading_rad_per_sqrt_s || odometry.sigma_heading_rad_per_sqrt_turn ||
             odometry.sigma_omega_radps,
         vehicle, "noise along the way or of the heading (sigma_v_mps and sigma_steering are)");
  refuse(sensor.range_scale != 1.0, vehicle, "sensor.range_scale");
  refuse(sensor.range_offset_m != 0.0, vehicle, "sensor.range_offset_m");
  refuse(sensor.sigma_point_m.has_value(), vehicle, "sensor.sigma_point_m");
}

void take_truck(CLI::App& command, const std::string& section, const logs::Vehicle& vehicle,
                logs::AcfrSettings& truck) {
  const logs::SensorModel& sensor = only_sensor(vehicle);
  const logs::OdometryModel& odometry = vehicle.odometry;
  refuse_of_truck(vehicle, sensor);
  const auto set = [&](const char* key, std::optional<double> value, double factor = 1.0) {
    if (value) set_unless_given(command, "--" + section + '.' + key, *value * factor);
  };
  if (odometry.wheelbase_m) {  // the file describes a truck
    truck.geometry.wheelbase_m = *odometry.wheelbase_m;
    truck.geometry.encoder_offset_m = odometry.encoder_offset_m;
    set("speed_scale", odometry.scale);
    set("steering_scale", odometry.steering_scale);
    set("steering_offset_rad", odometry.steering_offset_rad);
    set("sigma_sideways", odometry.sigma_sideways_m_per_sqrt_m.value_or(0.0), odometry.noise_scale);
  } else {
    refuse(odometry.scale != 1.0 || odometry.steering_scale != 1.0 || odometry.steering_offset_rad != 0.0 ||
               odometry.sigma_sideways_m_per_sqrt_m || odometry.noise_scale != 1.0,
           vehicle, "an [odometry] without wheelbase_m");
  }
  set("sigma_speed_mps", odometry.sigma_v_mps, odometry.noise_scale);
  set("sigma_steering_rad", odometry.sigma_steering_rad, odometry.noise_scale);
  if (is_mounted(sensor)) {
    truck.T_robot_laser.x_m = sensor.T_vehicle_sensor.x_m;
    truck.T_robot_laser.y_m = sensor.T_vehicle_sensor.y_m;
    set("laser_heading_rad", sensor.T_vehicle_sensor.heading_rad);
    set("laser_delay_s", sensor.delay_s);
  }
  const bool scaled = sensor.noise_scale != 1.0;  // of the noise that ships, where the file states none
  if (sensor.sigma_range_m || scaled)
    set("sigma_range_m", sensor.sigma_range_m.value_or(truck.sigma_range_m), sensor.noise_scale);
  if (sensor.sigma_bearing_rad || scaled)
    set("sigma_bearing_rad", sensor.sigma_bearing_rad.value_or(truck.sigma_bearing_rad), sensor.noise_scale);
}

void take_plaza(CLI::App& command, const logs::Vehicle& vehicle, Settings& settings) {
  const logs::SensorModel& sensor = only_sensor(vehicle);
  const logs::OdometryModel& odometry = vehicle.odometry;
  refuse(odometry.scale != 1.0 || odometry.turn_scale != 1.0 || odometry.turn_bias_radps != 0.0, vehicle,
         "a scale or bias of the odometry");
  refuse(odometry.sigma_heading_rad_per_sqrt_s || odometry.sigma_heading_rad_per_sqrt_turn || odometry.sigma_v_mps ||
             odometry.sigma_omega_radps || odometry.sigma_steering_rad,
         vehicle, "noise by the time, by turns or of a sample");
  refuse(is_mounted(sensor), vehicle, "a mounting or delay of the sensor");
  refuse(sensor.range_offset_m != 0.0, vehicle, "sensor.range_offset_m");
  logs::PlazaSettings& plaza = settings.logs.plaza;
  const double factor = odometry.noise_scale;
  const auto take = [factor](const std::optional<double>& value, double& to) { to = value.value_or(to) * factor; };
  take(odometry.sigma_along_m_per_sqrt_m, plaza.sigma_distance_m_per_sqrt_m);
  take(odometry.sigma_sideways_m_per_sqrt_m, plaza.sigma_sideways_m_per_sqrt_m);
  take(odometry.sigma_heading_rad_per_sqrt_m, plaza.sigma_heading_rad_per_sqrt_m);
  if (sensor.sigma_range_m || sensor.noise_scale != 1.0) {
    const double sigma_m = sensor.sigma_range_m.value_or(plaza.sigma_range_m);
    set_unless_given(command, "--plaza.sigma_range_m", sigma_m * sensor.noise_scale);
  }
  if (sensor.range_scale != 1.0) set_unless_given(command, "--plaza.range_scale", sensor.range_scale);
}

}  // namespace

bool has_vehicle_model(logs::LogFormat format) {
  using logs::LogFormat;
  return format == LogFormat::acfr_ascii || format == LogFormat::victoria_park_mat ||
         format == LogFormat::car_park_mat || format == LogFormat::plaza;
}

bool take_vehicle_of_log(CLI::App& command, logs::LogFormat format, const logs::Vehicle& vehicle, Settings& settings) {
  switch (format) {
    case logs::LogFormat::acfr_ascii:
    case logs::LogFormat::victoria_park_mat:
      take_truck(command, "victoria_park", vehicle, settings.logs.victoria_park);
      return true;
    case logs::LogFormat::car_park_mat:
      take_truck(command, "car_park", vehicle, settings.logs.car_park);
      return true;
    case logs::LogFormat::plaza:
      take_plaza(command, vehicle, settings);
      return true;
    default:
      return false;
  }
}

}  // namespace helixnav::apps
