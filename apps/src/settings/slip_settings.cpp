// SPDX-License-Identifier: BSD-3-Clause
#include "setting_options.hpp"

namespace helixnav::apps {

void add_slip_settings(CLI::App& command, Settings& settings) {
  supervisor::SlipOptions& slip = settings.navigator.slip;
  command
      .add_option_function<std::string>(
          "--slip.enabled", [&slip](const std::string& word) { slip.enabled = word == "true"; },
          "Detect wheel slip from landmarks that appear beside their expected positions; false: trust the odometry")
      ->check(one_of({"true", "false"}))
      ->default_str("true")
      ->group(settings_group);
  add_number(command, "--slip.nats", slip.nats, 0.0, 1e6,
             "A slip must explain a scan better than no slip by this much");
  supervisor::MovingOptions& moving = settings.navigator.moving;
  command
      .add_option_function<std::string>(
          "--moving.enabled", [&moving](const std::string& word) { moving.enabled = word == "true"; },
          "Drop landmarks whose sightings show that they move; false: assume that nothing moves")
      ->check(one_of({"true", "false"}))
      ->default_str("true")
      ->group(settings_group);
  supervisor::NoiseOptions& noise = settings.navigator.noise;
  command
      .add_option_function<std::string>(
          "--noise.adapt", [&noise](const std::string& word) { noise.adapt = word == "true"; },
          "Learn factors on the covariances of odometry and observations while driving; false: use the assumed "
          "covariances")
      ->check(one_of({"true", "false"}))
      ->default_str("true")
      ->group(settings_group);
  command
      .add_option_function<std::string>(
          "--noise.systematic", [&noise](const std::string& word) { noise.systematic = word == "true"; },
          "Learn constant errors of odometry and sensors (scale, turning, heading, range) while driving and take them "
          "out; false: there are none")
      ->check(one_of({"true", "false"}))
      ->default_str("true")
      ->group(settings_group);
}

}  // namespace helixnav::apps
