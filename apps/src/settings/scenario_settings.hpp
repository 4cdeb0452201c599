// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "helixnav/sim/scenario.hpp"

namespace CLI {
class App;
}

namespace helixnav::apps {

/// The settable parts of a named scenario; nothing: as in the scenario.
struct ScenarioSettings {
  std::optional<double> slip_every_m;
  std::optional<double> slip_least_m, slip_most_m;
  std::optional<double> slip_least_deg, slip_most_deg;
  std::optional<double> tour_m;
  std::optional<double> blocks_a_side;
  std::optional<double> classes, class_error, sigma_size_m;
  std::optional<double> movers, mover_cars;
  std::optional<double> trees_a_m2, twins;
  bool announce_carried = false;
  double assumed_odometry_factor = 1.0;
  double assumed_detector_factor = 1.0;
};

/// Options --sim.KEY of a command.
void add_scenario_settings(CLI::App& command, ScenarioSettings& settings);

/// The scenario of that name with these settings. InputError as in check_scenario.
sim::Scenario scenario_of(const std::string& name, const ScenarioSettings& settings);

}  // namespace helixnav::apps
