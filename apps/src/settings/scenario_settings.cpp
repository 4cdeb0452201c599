// SPDX-License-Identifier: BSD-3-Clause
#include "scenario_settings.hpp"

#include <cmath>

#include <CLI/CLI.hpp>

#include "helixnav/core/angle.hpp"
#include "validators.hpp"

namespace helixnav::apps {
namespace {

const char* const as_scenario = "auto";

/// A number, or "auto": as in the scenario.
void add_number(CLI::App& command, const char* name, std::optional<double>& value, double low, double high,
                const char* help) {
  const CLI::Validator number = number_between(low, high);
  const auto objection = [number](std::string& word) { return word == as_scenario ? std::string() : number(word); };
  const auto set = [&value](const std::string& word) {
    value.reset();
    if (word != as_scenario) value = std::stod(word);
  };
  command.add_option_function<std::string>(name, set, help)
      ->check(CLI::Validator(objection, number.get_description() + " or auto"))
      ->default_str(as_scenario)
      ->group("Scenario (auto: as it is by its name)");
}

void add_factor(CLI::App& command, const char* name, double& value, const char* help) {
  command.add_option(name, value, help)
      ->capture_default_str()
      ->check(number_between(1e-3, 1e3))
      ->group("Scenario (auto: as it is by its name)");
}

double radians(double angle_deg) { return angle_deg * core::pi / 180.0; }

}  // namespace

void add_scenario_settings(CLI::App& command, ScenarioSettings& settings) {
  add_number(command, "--sim.tour_m", settings.tour_m, 10.0, 1e6, "Length of the tour through a town");
  add_number(command, "--sim.blocks_a_side", settings.blocks_a_side, 1.0, 1e3,
             "Blocks of a town in each direction, rounded to a whole number");
  add_number(command, "--sim.slip_every_m", settings.slip_every_m, 0.0, 1e6,
             "Mean drive between two slips that odometry does not know; 0: never");
  add_number(command, "--sim.slip_least_m", settings.slip_least_m, 0.0, 1e3, "Least displacement by a slip");
  add_number(command, "--sim.slip_most_m", settings.slip_most_m, 0.0, 1e3, "Most displacement by a slip");
  add_number(command, "--sim.slip_least_deg", settings.slip_least_deg, 0.0, 180.0, "Least turn by a slip");
  add_number(command, "--sim.slip_most_deg", settings.slip_most_deg, 0.0, 180.0, "Most turn by a slip");
  add_number(command, "--sim.classes", settings.classes, 0.0, 1000.0,
             "Classes of trees that the detector names, rounded to a whole number; 0: none");
  add_number(command, "--sim.class_error", settings.class_error, 0.0, 0.5,
             "Share of detections that name another class");
  add_number(command, "--sim.sigma_size_m", settings.sigma_size_m, 0.0, 100.0,
             "Noise of the diameters that the detector measures (0.2 to 0.8 m); 0: it measures none");
  add_number(command, "--sim.movers", settings.movers, 0.0, 100.0,
             "Things in view on the mean that move and are detected like trees");
  add_number(command, "--sim.mover_cars", settings.mover_cars, 0.0, 1.0,
             "Share of cars among the things that move; the others walk");
  add_number(command, "--sim.trees_a_m2", settings.trees_a_m2, 0.0, 0.25, "Trees of a forest, on the mean");
  add_number(command, "--sim.twins", settings.twins, 0.0, 1.0, "Share of the trees of a forest with a second stem");
  command
      .add_option("--sim.announce_carried", settings.announce_carried,
                  "Whether an event says that the vehicle was carried (kidnapped)")
      ->capture_default_str()
      ->group("Scenario (auto: as it is by its name)");
  add_factor(command, "--sim.assumed_odometry_factor", settings.assumed_odometry_factor,
             "Standard deviations that odometry claims are multiplied by this");
  add_factor(command, "--sim.assumed_detector_factor", settings.assumed_detector_factor,
             "Standard deviations that observations claim are multiplied by this");
}

sim::Scenario scenario_of(const std::string& name, const ScenarioSettings& settings) {
  sim::Scenario scenario = sim::named_scenario(name);
  if (settings.tour_m) scenario.world.tour_m = *settings.tour_m;
  if (settings.blocks_a_side) scenario.world.blocks_a_side = static_cast<int>(std::lround(*settings.blocks_a_side));
  if (settings.slip_every_m) scenario.slip.every_m = *settings.slip_every_m;
  if (settings.slip_least_m) scenario.slip.distance_m.min = *settings.slip_least_m;
  if (settings.slip_most_m) scenario.slip.distance_m.max = *settings.slip_most_m;
  if (settings.slip_least_deg) scenario.slip.turn_rad.min = radians(*settings.slip_least_deg);
  if (settings.slip_most_deg) scenario.slip.turn_rad.max = radians(*settings.slip_most_deg);
  sim::LooksOptions& looks = scenario.scanner.looks;
  if (settings.classes) looks.classes = static_cast<int>(std::lround(*settings.classes));
  if (settings.class_error) looks.class_error = *settings.class_error;
  if (settings.sigma_size_m) looks.sigma_size_m = *settings.sigma_size_m;
  if (settings.movers) scenario.movers.in_view = *settings.movers;
  if (settings.mover_cars) scenario.movers.car_share = *settings.mover_cars;
  if (settings.trees_a_m2) scenario.world.trees_a_m2 = *settings.trees_a_m2;
  if (settings.twins) scenario.world.twin_share = *settings.twins;
  scenario.carried.announced = settings.announce_carried;
  scenario.assumed_noise =
      sim::scaled(scenario.assumed_noise, settings.assumed_odometry_factor, settings.assumed_detector_factor);
  sim::check_scenario(scenario);
  return scenario;
}

}  // namespace helixnav::apps
