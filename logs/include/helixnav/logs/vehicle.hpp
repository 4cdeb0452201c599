// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::logs {

/// How odometry becomes motion, and how well it is known. Values not given are empty.
struct OdometryModel {
  core::Pose2 T_vehicle_odometry;     ///< where it is measured, in the vehicle frame
  double scale = 1.0;                 ///< times every distance and speed
  double turn_scale = 1.0;            ///< times every turn
  double turn_bias_radps = 0.0;       ///< subtracted from every turn rate, after that
  double steering_scale = 1.0;        ///< times every steering angle, and …
  double steering_offset_rad = 0.0;   ///< … then added to it
  std::optional<double> wheelbase_m;  ///< rear axle to front axle; of steering
  double encoder_offset_m = 0.0;      ///< from the centre of the rear axle to the wheel measured, left positive
  std::optional<double> track_m;      ///< between the left and the right wheel; of wheels

  // Noise that grows with distance, time, or how far the vehicle turned either way (a turn is one of 360 degrees).
  std::optional<double> sigma_along_m_per_sqrt_m;
  std::optional<double> sigma_sideways_m_per_sqrt_m;
  std::optional<double> sigma_heading_rad_per_sqrt_m;
  std::optional<double> sigma_heading_rad_per_sqrt_s;
  std::optional<double> sigma_heading_rad_per_sqrt_turn;  ///< test: logs/own/turning_noise_test.cpp
  // Noise per sample.
  /// Of v; of v_left and of v_right each, unless sigma_omega is given: then of their mean. Test:
  /// logs/own/own_recording_test.cpp
  std::optional<double> sigma_v_mps;
  std::optional<double> sigma_omega_radps;
  std::optional<double> sigma_steering_rad;

  double noise_scale = 1.0;  ///< times every standard deviation, from the log or from these keys

  bool tells_noise() const {
    return sigma_along_m_per_sqrt_m || sigma_sideways_m_per_sqrt_m || sigma_heading_rad_per_sqrt_m ||
           sigma_heading_rad_per_sqrt_s || sigma_heading_rad_per_sqrt_turn || sigma_v_mps || sigma_omega_radps ||
           sigma_steering_rad;
  }
};

/// A detector of landmarks.
struct SensorModel {
  std::string name;
  core::Pose2 T_vehicle_sensor;
  std::optional<double> reach_m;           ///< landmarks are seen up to here
  std::optional<double> reliable_range_m;  ///< and reliably up to here: a missed landmark nearer than this is doubted
  double min_range_m = 0.0;
  std::optional<double> min_bearing_rad, max_bearing_rad;  ///< both or neither
  std::optional<double> sigma_range_m;
  std::optional<double> sigma_bearing_rad;
  std::optional<double> sigma_point_m;  ///< of x and of y, for detections as points
  double range_scale = 1.0;             ///< recorded range divided by true range
  double range_offset_m = 0.0;  ///< by which ranges are then too short: half a trunk where its near side is seen
  double delay_s = 0.0;         ///< a scan was taken this long before its stamp
  double arrives_late_s = 0.0;  ///< in a stream, its lines may come this long after others of the same time
  double noise_scale = 1.0;     ///< times every standard deviation, from the log or from these keys
  std::optional<double> detection_probability;
  std::optional<double> clutter_per_scan;
  std::optional<double> class_error;   ///< probability that a class is named wrongly
  std::optional<double> sigma_size_m;  ///< of a size
};

/// A vehicle as its vehicle.toml describes it. Its frame: x ahead, y left; its origin is the point whose path is
/// written.
struct Vehicle {
  std::string name;
  std::string path;  ///< of the file, for messages
  std::string text;  ///< of the file, as it is there
  OdometryModel odometry;
  std::vector<SensorModel> sensors;
  Eigen::Vector2d antenna_m = Eigen::Vector2d::Zero();
  std::optional<double> sigma_fix_m;
};

/// Reads a vehicle.toml (docs/your_own_log.md). Throws core::InputError naming file:line:column for text that is not
/// TOML, a key that is unknown (with the nearest one of its section), of the wrong type, out of range, or given in two
/// units. Test: logs/vehicle_test.cpp.
Vehicle read_vehicle(const std::filesystem::path& path);
/// The same for a text; `name` is used in messages in place of the path.
Vehicle read_vehicle_text(std::string_view text, const std::string& name);

}  // namespace helixnav::logs
