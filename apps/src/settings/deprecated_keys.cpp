// SPDX-License-Identifier: BSD-3-Clause
#include "deprecated_keys.hpp"

#include <array>
#include <cstdio>
#include <string_view>
#include <utility>

#include <CLI/CLI.hpp>

namespace helixnav::apps {
namespace {

using Replaced = std::pair<std::string_view, std::string_view>;

constexpr std::array<Replaced, 10> replaced_of_truck = {{{"sigma_speed_mps", "odometry.sigma_v_mps"},
                                                         {"sigma_steering_rad", "odometry.sigma_steering_rad"},
                                                         {"sigma_sideways", "odometry.sigma_sideways_m_per_sqrt_m"},
                                                         {"speed_scale", "odometry.scale"},
                                                         {"steering_offset_rad", "odometry.steering_offset_rad"},
                                                         {"steering_scale", "odometry.steering_scale"},
                                                         {"laser_heading_rad", "sensor.heading_rad"},
                                                         {"laser_delay_s", "sensor.delay_s"},
                                                         {"sigma_range_m", "sensor.sigma_range_m"},
                                                         {"sigma_bearing_rad", "sensor.sigma_bearing_rad"}}};
constexpr std::array<Replaced, 2> replaced_of_plaza = {
    {{"range_scale", "sensor.range_scale"}, {"sigma_range_m", "sensor.sigma_range_m"}}};

template <class Table>
std::string key_in(const Table& table, const std::string& name) {
  for (const auto& [setting, key] : table) {
    if (setting == name) return std::string(key);
  }
  return {};
}

/// --config of a run gives every key: those left at their defaults need no mention.
bool is_as_by_default(const CLI::Option& option) {
  double given = 0.0, usual = 0.0;
  return CLI::detail::lexical_cast(option.results().back(), given) &&
         CLI::detail::lexical_cast(option.get_default_str(), usual) && given == usual;
}

}  // namespace

std::string vehicle_key_of(const std::string& setting) {
  const std::size_t dot = setting.find('.');
  if (dot == std::string::npos) return {};
  const std::string section = setting.substr(0, dot), name = setting.substr(dot + 1);
  if (section == "victoria_park" || section == "car_park") return key_in(replaced_of_truck, name);
  return section == "plaza" ? key_in(replaced_of_plaza, name) : std::string();
}

std::string deprecated_keys_given(const CLI::App& command) {
  std::string given;
  for (const CLI::Option* option : command.get_options()) {
    const std::string key = vehicle_key_of(option->get_single_name());
    if (key.empty() || option->count() == 0 || is_as_by_default(*option)) continue;
    given += (given.empty() ? "" : "; ") + option->get_single_name() + " is now " + key;
  }
  if (given.empty()) return {};
  return "deprecated settings, which will go away: " + given +
         " of a vehicle file (helixnav new-vehicle DIR --like NAME writes one, --vehicle DIR/vehicle.toml takes it)";
}

void warn_of_deprecated_keys(const CLI::App& command) {
  const std::string sentence = deprecated_keys_given(command);
  if (!sentence.empty()) std::fprintf(stderr, "helixnav: warning: %s\n", sentence.c_str());
}

}  // namespace helixnav::apps
