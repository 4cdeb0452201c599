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

/// What the scanner tells of a tree besides where it is. Trees are of any class, and of any diameter between two, alike.
struct LooksOptions {
  int classes = 0;            ///< 0: no classes
  double class_error = 0.0;   ///< share of detections that name another class, any of them alike
  double sigma_size_m = 0.0;  ///< of the diameter; 0: no sizes
  Interval diameter_m{0.2, 0.8};
};

/// Scanner that finds trees: each visible one with a probability, and things that are none.
struct ScannerOptions {
  core::Pose2 T_robot_sensor{3.78, 0.50, 0.0};
  core::FieldOfView field_of_view{1.0, 30.0, -core::pi / 2.0, core::pi / 2.0};
  double detection_probability = 0.9;
  double clutter_per_scan = 0.5;    ///< mean of a Poisson number, uniform over the area of the field of view
  double occluding_radius_m = 0.0;  ///< of every trunk: a tree whose centre lies behind a nearer trunk is not seen
  LooksOptions looks = {};
};

/// White noise of the sensors.
struct NoiseLevels {
  core::AckermannNoise odometry{0.45, 0.0442};  ///< per sample; by default 0.1 m and 0.6° per scan of 1.5 m
  double sigma_range_m = 0.1;
  double sigma_bearing_rad = 0.7 * core::pi / 180.0;
};

/// What odometry's noise model does not know: a first-order Gauss-Markov error, drawn stationary.
struct OdometryBias {
  double sigma_steering_rad = 0.0;
  double sigma_speed_scale = 0.0;  ///< of the factor on the wheel speed
  double time_constant_s = 60.0;
};

/// What no odometry tells: the vehicle is displaced between two samples, in any direction, and turned to either side.
struct SlipOptions {
  double every_m = 0.0;  ///< mean distance driven between two slips, exponentially distributed; 0: never
  Interval distance_m{0.3, 0.8};
  Interval turn_rad{3.0 * core::pi / 180.0, 3.0 * core::pi / 180.0};  ///< absolute value
};

/// The vehicle is carried along its route, during a pause in which nothing is measured.
struct CarryOptions {
  double every_m = 0.0;  ///< driven between two times: from three to five quarters of it; 0: never
  Interval distance_m{100.0, 400.0};
  bool announced = false;  ///< by a core::Lost event
};

/// Things that move and are detected like trees: people walk beside the road, cars drive on it, either way. They come into
/// view and leave it again.
struct MoverOptions {
  double in_view = 0.0;    ///< on the mean over the scans of a drive
  double car_share = 0.5;  ///< of those that are met
  Interval walking_mps{0.5, 2.0};
  Interval driving_mps{4.0, 12.0};
};

/// Everything that a simulated run depends on, beside its seed. True noise is what happens, assumed noise is what the
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

/// Names that named_scenario knows, in the order in which to show them.
std::vector<std::string> scenario_names();

/// One of the scenarios by name, to use or to change. InputError for an unknown name, with the nearest known one.
/// Test: sim/scenario_test.cpp.
Scenario named_scenario(std::string_view name);

/// Noise with its standard deviations multiplied: those of odometry by one factor, those of the detector by another.
NoiseLevels scaled(const NoiseLevels& noise, double odometry_factor, double detector_factor);

/// Throws InputError that names the first key out of its range, with value and range.
/// Test: sim/scenario_test.cpp.
void check_scenario(const Scenario& scenario);

}  // namespace helixnav::sim
