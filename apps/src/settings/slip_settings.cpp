// SPDX-License-Identifier: BSD-3-Clause
#include "setting_options.hpp"

namespace helixnav::apps {

void add_slip_settings(CLI::App& command, Settings& settings) {
  supervisor::SlipOptions& slip = settings.navigator.slip;
  command
      .add_option_function<std::string>(
          "--slip.enabled", [&slip](const std::string& word) { slip.enabled = word == "true"; },
          "Landmarks beside where they are expected may say that the vehicle slipped; false: odometry is believed")
      ->check(one_of({"true", "false"}))
      ->default_str("true")
      ->group(settings_group);
  add_number(command, "--slip.nats", slip.nats, 0.0, 1e6,
             "By so much a slip must explain a scan better than no slip does");
  supervisor::MovingOptions& moving = settings.navigator.moving;
  command
      .add_option_function<std::string>(
          "--moving.enabled", [&moving](const std::string& word) { moving.enabled = word == "true"; },
          "Drop landmarks whose sightings say that they move; false: nothing moves")
      ->check(one_of({"true", "false"}))
      ->default_str("true")
      ->group(settings_group);
  supervisor::NoiseOptions& noise = settings.navigator.noise;
  command
      .add_option_function<std::string>(
          "--noise.adapt", [&noise](const std::string& word) { noise.adapt = word == "true"; },
          "Learn factors on the covariances of odometry and observations while driving, false: use them as "
          "assumed")
      ->check(one_of({"true", "false"}))
      ->default_str("true")
      ->group(settings_group);
}

}  // namespace helixnav::apps
