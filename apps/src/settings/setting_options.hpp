// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "common/help_pages.hpp"
#include "settings.hpp"
#include "validators.hpp"

namespace helixnav::apps {

template <typename T>
CLI::Option* add_number(CLI::App& command, const char* name, T& value, T low, T high, const char* help) {
  return command.add_option(name, value, help)
      ->capture_default_str()
      ->check(number_between(low, high))
      ->group(settings_group);
}

/// A length that is a multiple of the sensor's reach ("auto") unless it is given in metres.
CLI::Option* add_length(CLI::App& command, Settings& settings, const std::string& key, double low, double high,
                        const std::string& help);

/// A number that is determined elsewhere unless it is given ("auto").
CLI::Option* add_automatic(CLI::App& command, const char* name, std::optional<double>& value, double low, double high,
                           const char* help);

/// Parts of add_settings, in their order in help and configuration files.
void add_sensor_settings(CLI::App& command, Settings& settings);
void add_search_settings(CLI::App& command, Settings& settings);
void add_slip_settings(CLI::App& command, Settings& settings);
void add_fastslam_settings(CLI::App& command, FastSlamSettings& settings);
void add_log_settings(CLI::App& command, Settings& settings);

}  // namespace helixnav::apps
