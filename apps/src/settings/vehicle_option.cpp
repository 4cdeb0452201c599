// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_option.hpp"

#include <array>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <variant>

#include <CLI/CLI.hpp>

#include "common/fit_to_recording.hpp"
#include "common/input_files.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/logs/own_log.hpp"
#include "helixnav/logs/read_recording.hpp"
#include "helixnav/logs/shipped_vehicle.hpp"
#include "vehicle_of_log.hpp"

namespace helixnav::apps {
namespace {

/// The minimum over the sensors: a landmark missed by the weakest is no evidence.
void set_detection(CLI::App& command, const logs::Vehicle& vehicle) {
  std::optional<double> probability, clutter;
  for (const logs::SensorModel& sensor : vehicle.sensors) {
    if (sensor.detection_probability) probability = std::min(probability.value_or(1.0), *sensor.detection_probability);
    if (sensor.clutter_per_scan) clutter = std::max(clutter.value_or(0.0), *sensor.clutter_per_scan);
  }
  if (probability) {
    set_unless_given(command, "--association.detection_probability", *probability);
    set_unless_given(command, "--landmarks.detection_probability", *probability);
    set_unless_given(command, "--fastslam.detection_probability", *probability);
  }
  constexpr double new_per_scan = 0.5;
  if (clutter) set_unless_given(command, "--association.extraneous_per_scan", *clutter + new_per_scan);
}

void refuse_what_goes_nowhere(const logs::Vehicle& vehicle) {
  const logs::SensorModel& sensor = vehicle.sensors.front();
  const logs::OdometryModel& odometry = vehicle.odometry;
  const bool moves = odometry.tells_noise() || odometry.scale != 1.0 || odometry.turn_scale != 1.0 ||
                     odometry.turn_bias_radps != 0.0 || !odometry.T_vehicle_odometry.vector().isZero(0.0);
  const bool mounts = !sensor.T_vehicle_sensor.vector().isZero(0.0) || sensor.delay_s != 0.0 ||
                      sensor.range_scale != 1.0 || sensor.range_offset_m != 0.0;
  if (!moves && !mounts) return;
  throw core::InputError(vehicle.path + ": a log of this format brings its own " +
                         (moves ? "odometry and its noise" : "mounting and times") +
                         "; only the view, the noise and the probabilities of the [[sensor]], and noise_scale of both, "
                         "can be given");
}

void tell_noise(const logs::SensorModel& sensor, core::Observation& observation) {
  using core::ObservationKind;
  const auto tell = [&](int row, const std::optional<double>& sigma) {
    if (!sigma) return;
    observation.R.row(row).setZero();
    observation.R.col(row).setZero();
    observation.R(row, row) = *sigma * *sigma;
  };
  switch (observation.kind) {
    case ObservationKind::range_bearing:
      tell(0, sensor.sigma_range_m);
      return tell(1, sensor.sigma_bearing_rad);
    case ObservationKind::range:
      return tell(0, sensor.sigma_range_m);
    case ObservationKind::bearing:
      return tell(0, sensor.sigma_bearing_rad);
    case ObservationKind::cartesian:
      tell(0, sensor.sigma_point_m);
      return tell(1, sensor.sigma_point_m);
  }
}

}  // namespace

void set_unless_given(CLI::App& command, const std::string& option_name, double value) {
  CLI::Option* option = command.get_option_no_throw(option_name);
  if (option == nullptr || option->count() > 0) return;
  std::array<char, 32> digits{};  // the fewest that read back as the same number
  const char* const begin = digits.data();
  const char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  option->add_result(std::string(begin, end));
  option->run_callback();
}

void add_vehicle_option(CLI::App& command, std::string& file, const std::string& without) {
  command
      .add_option("--vehicle", file,
                  "The vehicle, its sensors and their noise: a file, or one that ships (" +
                      CLI::detail::join(logs::shipped_vehicle_names(), ", ") + ")" + without)
      ->type_name("FILE");
}

std::vector<runs::InputFile> vehicle_inputs(const std::string& file) {
  if (file.empty() || !std::filesystem::exists(file)) return {};
  return input_files(file);
}

void apply_vehicle(CLI::App& command, const std::string& file, const std::string& log, Settings& settings) {
  std::string path = file;
  if (path.empty() && logs::is_own_log(log)) path = logs::vehicle_beside(log).string();
  if (path.empty()) {
    const std::optional<std::string> ships =
        std::filesystem::exists(log) ? logs::shipped_vehicle_of(logs::recognise(log)) : std::nullopt;
    if (ships) take_vehicle_of_log(command, logs::recognise(log), logs::shipped_vehicle(*ships), settings);
    return;
  }
  settings.logs.vehicle = logs::find_vehicle(path);
  set_detection(command, *settings.logs.vehicle);
  if (settings.logs.vehicle->sigma_fix_m)
    set_unless_given(command, "--gps.sigma_m", *settings.logs.vehicle->sigma_fix_m);
  if (std::filesystem::exists(log)) {
    take_vehicle_of_log(command, logs::recognise(log), *settings.logs.vehicle, settings);
  }
}

void tell_vehicle(core::Recording& recording, logs::LogFormat format, const logs::Vehicle& vehicle) {
  if (format == logs::LogFormat::own) return;
  if (vehicle.sensors.size() != 1) {
    throw core::InputError(vehicle.path + ": a log of this format has one sensor; expected one [[sensor]], found " +
                           std::to_string(vehicle.sensors.size()));
  }
  const bool has_model = has_vehicle_model(format);
  if (!has_model) refuse_what_goes_nowhere(vehicle);
  const logs::SensorModel& sensor = vehicle.sensors.front();
  if (!sensor.reach_m && sensor.reliable_range_m) logs::estimate_missing_field_of_view(recording);
  for (core::Event& event : recording.events) {
    auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    logs::tell_view(sensor, scan->field_of_view);
    if (has_model) continue;
    for (core::Observation& observation : scan->observations) tell_noise(sensor, observation);
  }
  const double of_odometry = vehicle.odometry.noise_scale, of_sensor = sensor.noise_scale;
  if (!has_model) scale_covariances(recording, of_odometry * of_odometry, of_sensor * of_sensor);
}

void print_remarks(const core::Recording& recording) {
  for (const std::string& remark : recording.remarks) std::fprintf(stderr, "helixnav: note: %s\n", remark.c_str());
}

}  // namespace helixnav::apps
