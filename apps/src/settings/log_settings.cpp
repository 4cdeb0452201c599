// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <CLI/CLI.hpp>

#include "deprecated_keys.hpp"
#include "setting_options.hpp"
#include "validators.hpp"

namespace helixnav::apps {
namespace {

/// For an option that a vehicle file also states.
void add_deprecated(CLI::App& command, const std::string& setting, double& value, double low, double high,
                    const std::string& help) {
  const std::string text = help + " (deprecated: " + vehicle_key_of(setting) + " of --vehicle)";
  add_number(command, ("--" + setting).c_str(), value, low, high, text.c_str());
}

void add_truck(CLI::App& command, const std::string& section, logs::AcfrSettings& truck) {
  const auto add = [&](const char* key, double& value, double low, double high, const char* help) {
    add_deprecated(command, section + "." + key, value, low, high, help);
  };
  add("sigma_speed_mps", truck.noise.sigma_speed_mps, 1e-3, 10.0, "Noise of one sample of the wheel's speed");
  add("sigma_steering_rad", truck.noise.sigma_steering_rad, 1e-4, 1.0, "Noise of one sample of the steering angle");
  add("sigma_sideways", truck.sigma_sideways_m_per_sqrt_m, 0.0, 1.0,
      "Side-slip noise over one metre; grows with the square root of the distance [m]");
  add("speed_scale", truck.speed_scale, 0.5, 2.0, "Every recorded speed of the wheel is multiplied by this");
  add("steering_offset_rad", truck.steering_offset_rad, -0.5, 0.5, "Added to every recorded steering angle");
  add("steering_scale", truck.steering_scale, 0.5, 2.0, "Every recorded steering angle is multiplied by this first");
  add("laser_heading_rad", truck.T_robot_laser.heading_rad, -core::pi, core::pi,
      "Direction of the laser, counter-clockwise from straight ahead");
  add("laser_delay_s", truck.laser_delay_s, 0.0, 1.0, "Time by which a scan was taken before its stamp");
  add("sigma_range_m", truck.sigma_range_m, 1e-3, 100.0, "Noise of a detection's range");
  add("sigma_bearing_rad", truck.sigma_bearing_rad, 1e-4, 1.0, "Noise of a detection's bearing");
}

void add_plaza(CLI::App& command, Settings& settings) {
  add_deprecated(
      command, "plaza.range_scale", settings.plaza_range_scale, 0.0, 2.0,
      "Recorded range over true one; 0: estimated from the log by the least innovations (known association)");
  add_deprecated(command, "plaza.sigma_range_m", settings.logs.plaza.sigma_range_m, 1e-3, 100.0, "Noise of a range");
}

void add_mrclam(CLI::App& command, logs::MrclamSettings& mrclam) {
  add_number(command, "--mrclam.sigma_range_m", mrclam.sigma_range_m, 1e-3, 100.0, "Noise of a range");
  add_number(command, "--mrclam.sigma_bearing_rad", mrclam.sigma_bearing_rad, 1e-4, 1.0, "Noise of a bearing");
  add_number(command, "--mrclam.looks_as_one", mrclam.looks_as_one, 1.0, 1e3,
             "Consecutive looks that carry the information of one: both noises apply to all of them together, and "
             "landmarks without a name are distinguished by the noise of one");
  add_number(command, "--mrclam.sigma_speed", mrclam.sigma_speed_m_per_sqrt_s, 1e-4, 10.0,
             "Noise along the path for one second under command [m]");
  add_number(command, "--mrclam.sigma_side", mrclam.sigma_side_m_per_sqrt_s, 1e-4, 10.0,
             "Noise across the path for one second under command [m]");
  add_number(command, "--mrclam.sigma_turn", mrclam.sigma_turn_rad_per_sqrt_s, 1e-4, 10.0,
             "Noise of the heading for one second under command [rad]");
}

void add_gps(CLI::App& command, Settings& settings) {
  GpsSettings& gps = settings.gps;
  command
      .add_option_function<std::string>(
          "--gps.use,--gps", [&gps](const std::string& word) { gps.fuse = word == "fuse"; },
          "truth: GPS is only used for comparison; fuse: it updates the pose, and the map frame is that of the GPS, "
          "with the start pose aligned to the fixes of the first gps.start_m metres, or fewer. Errors against GPS are "
          "then "
          "not independent")
      ->check(one_of({"truth", "fuse"}))
      ->default_str("truth")
      ->group(settings_group);
  add_number(command, "--gps.sigma_m", gps.sigma_m, 1e-3, 1000.0, "Noise of a fix in x and in y (fuse)");
  add_number(
      command, "--gps.start_m", gps.start_m, 1.0, 1e5,
      "Length of the drive used to align the start with the GPS frame, unless its heading is sure before (fuse)");
  add_number(command, "--gps.gate_probability", settings.navigator.fix_probability, 0.5, 0.999999,
             "Gate of a fix, as the probability that a correct one is inside (fuse)");
}

}  // namespace

void add_sensor_settings(CLI::App& command, Settings& settings) {
  add_number(command, "--log.covariance_scale", settings.covariance_scale, 1e-6, 1e6,
             "Factor on every covariance of odometry and observations; DLR run e is right with 2.07");
  logs::GivenFieldOfView& view = settings.field_of_view;
  add_number(command, "--log.max_range_m", view.max_range_m, 0.0, 1e5,
             "Range of the sensor; 0: as the log says, or estimated from its observations (DLR)");
  const auto set_width = [&view](double width_deg) { view.width_rad = width_deg * core::pi / 180.0; };
  command
      .add_option_function<double>("--log.view_deg", set_width,
                                   "Width of the field of view, centred straight ahead; 0: likewise")
      ->check(number_between(0.0, 360.0))
      ->default_str("0")
      ->group(settings_group);
}

void add_log_settings(CLI::App& command, Settings& settings) {
  add_truck(command, "victoria_park", settings.logs.victoria_park);
  add_truck(command, "car_park", settings.logs.car_park);
  add_plaza(command, settings);
  add_mrclam(command, settings.logs.mrclam);
  add_gps(command, settings);
}

}  // namespace helixnav::apps
