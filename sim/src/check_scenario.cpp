// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <sstream>
#include <string>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/sim/scenario.hpp"

namespace helixnav::sim {
namespace {

constexpr double unlimited = std::numeric_limits<double>::max();

void require(const char* key, double value, double low, double high) {
  if (value >= low && value <= high) return;
  std::ostringstream message;
  message << "scenario: " << key << " = " << value << ", allowed is " << low << " to ";
  if (high < unlimited) {
    message << high;
  } else {
    message << "any";
  }
  throw core::InputError(message.str());
}

void require(const char* key, const Interval& interval, double low, double high) {
  require((std::string(key) + ".min").c_str(), interval.min, low, high);
  require((std::string(key) + ".max").c_str(), interval.max, interval.min, high);
}

void check_world(const WorldOptions& world) {
  require("world.loop_length_m", world.loop_length_m, 10.0, 1e5);
  const bool has_bare_stretch = world.kind == WorldKind::loop || world.kind == WorldKind::open_road;
  require("world.bare_length_m", world.bare_length_m, 0.0,
          has_bare_stretch ? 0.9 * world.loop_length_m.min : unlimited);
  require("world.tree_spacing_m", world.tree_spacing_m, nearest_trees_m, unlimited);
  require("world.tree_offset_m", world.tree_offset_m, 0.0, unlimited);
  require("world.road_clearance_m", world.road_clearance_m, 0.0, unlimited);
  require("world.changed_share", world.changed_share, 0.0, 1.0);
  require("world.drive_on_m", world.drive_on_m, 0.0, 1e5);
  require("world.returns", world.returns, 1.0, 1000.0);
  require("world.lattice_pitch_m", world.lattice_pitch_m, nearest_trees_m, unlimited);
  require("world.circuit_landmarks", world.circuit_landmarks, 0.0, 1e6);
  require("world.blackout_length_m", world.blackout_length_m, 0.0, unlimited);
  require("world.tour_m", world.tour_m, 10.0, 1e6);
  require("world.block_side_m", world.block_side_m, 40.0, 1e4);
  require("world.blocks_a_side", world.blocks_a_side, 1.0, 1e3);
  require("world.bare_share", world.bare_share, 0.0, 1.0);
  require("world.trees_a_m2", world.trees_a_m2, 0.0, 1.0 / (nearest_trees_m * nearest_trees_m));
  require("world.twin_share", world.twin_share, 0.0, 1.0);
  require("world.twin_m", world.twin_m, 0.01, nearest_trees_m);
}

void check_vehicle(const VehicleOptions& vehicle) {
  require("vehicle.wheelbase_m", vehicle.geometry.wheelbase_m, 1e-3, unlimited);
  require("vehicle.speed_mps", vehicle.speed_mps, 1e-3, unlimited);
  require("vehicle.odometry_period_s", vehicle.odometry_period_s, 1e-6, unlimited);
  require("vehicle.samples_per_scan", vehicle.samples_per_scan, 1.0, 1e6);
  require("vehicle.lookahead_m", vehicle.lookahead_m, 1e-3, unlimited);
}

void check_scanner(const ScannerOptions& scanner) {
  const core::FieldOfView& view = scanner.field_of_view;
  require("scanner.min_range_m", view.min_range_m, 0.0, unlimited);
  require("scanner.max_range_m", view.max_range_m, view.min_range_m, unlimited);
  require("scanner.min_bearing_rad", view.min_bearing_rad, -core::pi, core::pi);
  require("scanner.max_bearing_rad", view.max_bearing_rad, view.min_bearing_rad, core::pi);
  require("scanner.detection_probability", scanner.detection_probability, 0.0, 1.0);
  require("scanner.clutter_per_scan", scanner.clutter_per_scan, 0.0, 500.0);
  require("scanner.occluding_radius_m", scanner.occluding_radius_m, 0.0, unlimited);
  require("scanner.looks.classes", scanner.looks.classes, 0.0, 1000.0);
  require("scanner.looks.class_error", scanner.looks.class_error, 0.0, 0.5);
  require("scanner.looks.sigma_size_m", scanner.looks.sigma_size_m, 0.0, 100.0);
  require("scanner.looks.diameter_m", scanner.looks.diameter_m, 1e-3, 1e3);
}

void check_noise(const NoiseLevels& noise, const std::string& whose, double least_sigma) {
  require((whose + ".sigma_speed_mps").c_str(), noise.odometry.sigma_speed_mps, 0.0, unlimited);
  require((whose + ".sigma_steering_rad").c_str(), noise.odometry.sigma_steering_rad, 0.0, unlimited);
  require((whose + ".sigma_range_m").c_str(), noise.sigma_range_m, least_sigma, unlimited);
  require((whose + ".sigma_bearing_rad").c_str(), noise.sigma_bearing_rad, least_sigma, unlimited);
}

void check_slip(const SlipOptions& slip) {
  require("slip.every_m", slip.every_m, 0.0, unlimited);
  require("slip.distance_m", slip.distance_m, 0.0, unlimited);
  require("slip.turn_rad", slip.turn_rad, 0.0, core::pi);
}

void check_carried(const CarryOptions& carried) {
  require("carried.every_m", carried.every_m, 0.0, unlimited);
  require("carried.distance_m", carried.distance_m, 0.0, unlimited);
}

void check_movers(const MoverOptions& movers) {
  require("movers.in_view", movers.in_view, 0.0, 100.0);
  require("movers.car_share", movers.car_share, 0.0, 1.0);
  require("movers.walking_mps", movers.walking_mps, 0.0, 100.0);
  require("movers.driving_mps", movers.driving_mps, 0.0, 100.0);
}

}  // namespace

void check_scenario(const Scenario& scenario) {
  constexpr double least_assumed_sigma = 1e-9;  // an observation's R must be positive definite
  check_world(scenario.world);
  check_vehicle(scenario.vehicle);
  check_scanner(scenario.scanner);
  check_noise(scenario.true_noise, "true_noise", 0.0);
  check_noise(scenario.assumed_noise, "assumed_noise", least_assumed_sigma);
  require("bias.sigma_steering_rad", scenario.bias.sigma_steering_rad, 0.0, unlimited);
  require("bias.sigma_speed_scale", scenario.bias.sigma_speed_scale, 0.0, unlimited);
  require("bias.time_constant_s", scenario.bias.time_constant_s, 1e-3, unlimited);
  check_slip(scenario.slip);
  check_carried(scenario.carried);
  check_movers(scenario.movers);
}

}  // namespace helixnav::sim
