// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <set>
#include <string>
#include <string_view>

#include "helixnav/core/errors.hpp"
#include "helixnav/logs/vehicle.hpp"
#include "input_files.hpp"
#include "own/tables/table_reader.hpp"
#include "toml_section.hpp"

namespace helixnav::logs {
namespace {

constexpr double most_mounting_m = 1e5;
constexpr double least_sigma = 1e-9;  // of a standard deviation
constexpr double most_sigma = 1e4;
constexpr double whole_turn_rad = 2.0 * core::pi;

core::Pose2 pose_of(TomlSection& section) {
  const double x_m = section.number("x_m", -most_mounting_m, most_mounting_m).value_or(0.0);
  const double y_m = section.number("y_m", -most_mounting_m, most_mounting_m).value_or(0.0);
  return {x_m, y_m, section.angle("heading", -whole_turn_rad, whole_turn_rad).value_or(0.0)};
}

OdometryModel odometry_of(TomlSection section) {
  OdometryModel model;
  model.T_vehicle_odometry = pose_of(section);
  model.scale = section.number("scale", 0.01, 100.0).value_or(1.0);
  model.turn_scale = section.number("turn_scale", 0.01, 100.0).value_or(1.0);
  model.turn_bias_radps = section.angle("turn_bias", -10.0, 10.0, "_per_s").value_or(0.0);
  model.steering_scale = section.number("steering_scale", 0.01, 100.0).value_or(1.0);
  model.steering_offset_rad = section.angle("steering_offset", -1.0, 1.0).value_or(0.0);
  model.wheelbase_m = section.number("wheelbase_m", 1e-3, 1e3);
  model.encoder_offset_m = section.number("encoder_offset_m", -1e3, 1e3).value_or(0.0);
  model.track_m = section.number("track_m", 1e-3, 1e3);
  model.sigma_along_m_per_sqrt_m = section.number("sigma_along_m_per_sqrt_m", least_sigma, most_sigma);
  model.sigma_sideways_m_per_sqrt_m = section.number("sigma_sideways_m_per_sqrt_m", least_sigma, most_sigma);
  model.sigma_heading_rad_per_sqrt_m = section.angle("sigma_heading", least_sigma, most_sigma, "_per_sqrt_m");
  model.sigma_heading_rad_per_sqrt_s = section.angle("sigma_heading", least_sigma, most_sigma, "_per_sqrt_s");
  model.sigma_heading_rad_per_sqrt_turn = section.angle("sigma_heading", least_sigma, most_sigma, "_per_sqrt_turn");
  model.sigma_v_mps = section.number("sigma_v_mps", least_sigma, most_sigma);
  model.sigma_omega_radps = section.angle("sigma_omega", least_sigma, most_sigma, "_per_s");
  model.sigma_steering_rad = section.angle("sigma_steering", least_sigma, 1.0);
  model.noise_scale = section.number("noise_scale", 1e-3, 1e3).value_or(1.0);
  section.refuse_rest();
  return model;
}

void read_view(TomlSection& section, SensorModel& sensor) {
  sensor.reach_m = section.number("reach_m", 1e-3, most_mounting_m);
  sensor.reliable_range_m = section.number("reliable_range_m", 1e-3, most_mounting_m);
  sensor.min_range_m = section.number("min_range_m", 0.0, most_mounting_m).value_or(0.0);
  if (const auto view = section.angles("view", -2.0 * core::pi, 2.0 * core::pi)) {
    const bool is_all_around = view->second - view->first >= 2.0 * core::pi;
    sensor.min_bearing_rad = is_all_around ? -core::pi : view->first;
    sensor.max_bearing_rad = is_all_around ? core::pi : view->second;
  }
  if (sensor.reach_m && sensor.reliable_range_m && *sensor.reliable_range_m > *sensor.reach_m) {
    section.fail("reliable_range_m", "sensor.reliable_range_m: expected no more than reach_m");
  }
  const double limit_m = sensor.reliable_range_m.value_or(sensor.reach_m.value_or(most_mounting_m));
  if (sensor.min_range_m >= limit_m) section.fail("min_range_m", "sensor.min_range_m: expected less than the reach");
}

SensorModel sensor_of(TomlSection section) {
  SensorModel sensor;
  sensor.name = section.text("name").value_or("");
  sensor.T_vehicle_sensor = pose_of(section);
  read_view(section, sensor);
  sensor.sigma_range_m = section.number("sigma_range_m", least_sigma, most_sigma);
  sensor.sigma_bearing_rad = section.angle("sigma_bearing", least_sigma, core::pi);
  sensor.sigma_point_m = section.number("sigma_point_m", least_sigma, most_sigma);
  sensor.range_scale = section.number("range_scale", 0.01, 100.0).value_or(1.0);
  sensor.range_offset_m = section.number("range_offset_m", -100.0, 100.0).value_or(0.0);
  sensor.delay_s = section.number("delay_s", -100.0, 100.0).value_or(0.0);
  sensor.arrives_late_s = section.number("arrives_late_s", 0.0, 100.0).value_or(0.0);
  sensor.detection_probability = section.number("detection_probability", 0.15, 0.999);
  sensor.clutter_per_scan = section.number("clutter_per_scan", 0.0, 1000.0);
  sensor.class_error = section.number("class_error", 1e-6, 0.5);
  sensor.sigma_size_m = section.number("sigma_size_m", 1e-6, most_sigma);
  sensor.noise_scale = section.number("noise_scale", 1e-3, 1e3).value_or(1.0);
  section.refuse_rest();
  return sensor;
}

void check_names(TomlSection& root, const Vehicle& vehicle) {
  std::set<std::string> names;
  for (const SensorModel& sensor : vehicle.sensors) {
    if (names.insert(sensor.name).second) continue;
    root.fail("sensor", sensor.name.empty() ? "several sensors: each needs a name of its own, as in the column sensor"
                                            : "two sensors are called '" + sensor.name + "'");
  }
}

toml::table parse(std::string_view text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    fail_at(name, at.line, at.column, "no TOML: " + std::string(error.description()));
  }
}

}  // namespace

Vehicle read_vehicle(const std::filesystem::path& path) { return read_vehicle_text(read_file(path), path.string()); }

Vehicle read_vehicle_text(std::string_view text, const std::string& name) {
  const toml::table table = parse(text, name);
  TomlSection root(table, name, "");
  Vehicle vehicle;
  vehicle.path = name;
  vehicle.text = text;
  vehicle.name = root.text("name").value_or("");
  if (auto section = root.section("odometry")) vehicle.odometry = odometry_of(*section);
  for (const TomlSection& section : root.sections("sensor")) vehicle.sensors.push_back(sensor_of(section));
  check_names(root, vehicle);
  if (auto section = root.section("antenna")) {
    vehicle.antenna_m.x() = section->number("x_m", -most_mounting_m, most_mounting_m).value_or(0.0);
    vehicle.antenna_m.y() = section->number("y_m", -most_mounting_m, most_mounting_m).value_or(0.0);
    vehicle.sigma_fix_m = section->number("sigma_m", least_sigma, most_sigma);
    section->refuse_rest();
  }
  root.refuse_rest();
  return vehicle;
}

}  // namespace helixnav::logs
