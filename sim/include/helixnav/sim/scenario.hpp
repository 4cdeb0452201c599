// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "helixnav/core/ackermann.hpp"
#include "helixnav/core/angle.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/sim/world.hpp"

namespace helixnav::sim {

/// Car-like vehicle that follows its route by pure pursuit at constant speed of the rear axle.
struct VehicleOptions {
  core::AckermannGeometry geometry;
  double speed_mps = 3.0;
  double odometry_period_s = 0.1;  ///< one (speed, steering) sample, held constant in the meantime
  int samples_per_scan = 5;
  double lookahead_m = 5.0;
};

/// What the scanner reports of a tree besides where it is. Classes, and diameters between two bounds, are equally
/// likely.
struct LooksOptions {
  int classes = 0;            ///< 0: no classes
  double class_error = 0.0;   ///< share of detections that name another class, each equally likely
  double sigma_size_m = 0.0;  ///< of the diameter; 0: no sizes
  Interval diameter_m{0.2, 0.8};
};

/// Scanner that finds trees: each visible one with a probability, and false detections.
struct ScannerOptions {
  core::Pose2 T_robot_sensor{3.78, 0.50, 0.0};
  core::FieldOfView field_of_view{1.0, 30.0, -core::pi / 2.0, core::pi / 2.0};
  double detection_probability = 0.9;
  double clutter_per_scan = 0.5;    ///< mean of a Poisson number, uniform over the area of the field of view
  double occluding_radius_m = 0.0;  ///< of every trunk: a tree whose centre is behind a nearer trunk is not seen
  LooksOptions looks = {};
};

/// White noise of the sensors.
struct NoiseLevels {
  core::AckermannNoise odometry{0.45, 0.0442};  ///< per sample; by default 0.1 m and 0.6° per scan of 1.5 m
  double sigma_range_m = 0.1;
  double sigma_bearing_rad = 0.7 * core::pi / 180.0;
};

/// What odometry's noise model does not cover: a first-order Gauss-Markov error, drawn stationary.
struct OdometryBias {
  double sigma_steering_rad = 0.0;
  double sigma_speed_scale = 0.0;  ///< of the factor on the wheel speed
  double time_constant_s = 60.0;
};

/// What odometry does not measure: the vehicle is displaced between two samples, in any direction, and turned to either
/// side.
struct SlipOptions {
  double every_m = 0.0;  ///< mean distance driven between two slips, exponentially distributed; 0: never
  Interval distance_m{0.3, 0.8};
  Interval turn_rad{3.0 * core::pi / 180.0, 3.0 * core::pi / 180.0};  ///< absolute value
};

/// The vehicle is carried along its route, during a pause without measurements.
struct CarryOptions {
  double every_m = 0.0;  ///< driven between two events: three to five quarters of this; 0: never
  Interval distance_m{100.0, 400.0};
  bool announced = false;  ///< by a core::Lost event
};

/// Moving objects that are detected like trees: people walk beside the road, cars drive on it, in both directions. They
/// enter the view and leave it again.
struct MoverOptions {
  double in_view = 0.0;    ///< mean over the scans of a drive
  double car_share = 0.5;  ///< of those encountered
  Interval walking_mps{0.5, 2.0};
  Interval driving_mps{4.0, 12.0};
};

/// Everything a simulated run depends on, besides its seed. True noise is what happens, assumed noise is what the
/// events claim (covariance of Odometry, R of Observation).
struct Scenario {
  std::string name;
  std::string description;  ///< one line
  WorldOptions world;
  VehicleOptions vehicle;
  ScannerOptions scanner;
  NoiseLevels true_noise;
  NoiseLevels assumed_noise;
  OdometryBias bias;
  SlipOptions slip;
  CarryOptions carried;
  MoverOptions movers;
};

/// Names that named_scenario knows, in display order.
std::vector<std::string> scenario_names();

/// One of the scenarios by name, to use or to modify. InputError for an unknown name, with the nearest known one. Test:
/// sim/scenario_test.cpp.
Scenario named_scenario(std::string_view name);

/// Noise with its standard deviations multiplied: those of odometry by one factor, those of the detector by another.
NoiseLevels scaled(const NoiseLevels& noise, double odometry_factor, double detector_factor);

/// Throws InputError naming the first key out of range, with value and range. Test: sim/scenario_test.cpp.
void check_scenario(const Scenario& scenario);

}  // namespace helixnav::sim
