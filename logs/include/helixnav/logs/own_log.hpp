// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/recording.hpp"
#include "helixnav/logs/vehicle.hpp"

namespace helixnav::logs {

/// What the columns of odometry.csv contain.
enum class OdometryKind {
  increments,  ///< dx [m], dy [m], dheading [rad] since the row before
  velocities,  ///< v [m/s] ahead, vy [m/s] to the left, omega [rad/s], held until the next row
  steering,    ///< v [m/s] of a rear wheel, steering [rad], held until the next row
  wheels,      ///< v_left, v_right [m/s], held until the next row
  poses,       ///< x [m], y [m], heading [rad], from dead reckoning
};
std::string_view name_of(OdometryKind kind);

struct OwnOdometry {
  core::Nanoseconds t_ns = 0;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();  ///< according to the kind
};

/// One row of detections.csv. A row without any values only records that a scan was taken.
struct OwnDetection {
  core::Nanoseconds t_ns = 0;
  enum class Kind : std::uint8_t { nothing, range_bearing, cartesian, bearing, range } kind = Kind::nothing;
  std::uint8_t sensor = 0;     ///< index into OwnLog::sensor_names
  core::ClassName class_name;  ///< empty: no class
  core::Label label = core::no_label;
  std::array<double, 2> z{};
  std::array<double, 3> R{};  ///< (0,0), (0,1), (1,1); R(0,0) = 0: not given, the vehicle's applies
  double size_m = 0.0;        ///< 0: not given
  double sigma_size_m = 0.0;  ///< 0: not given, the vehicle's applies
};

struct OwnFix {
  core::Nanoseconds t_ns = 0;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  double sigma_m = 0.0;  ///< 0: not given
};

/// A log of the user's own, as it is in its files: SI units, each list in time order.
struct OwnLog {
  std::string name;
  OdometryKind odometry_kind = OdometryKind::increments;
  std::vector<OwnOdometry> odometry;
  std::vector<Eigen::Matrix3d> odometry_covariances;  ///< of the values; empty, or one per row
  std::vector<OwnDetection> detections;
  std::vector<std::string> sensor_names;  ///< as in the files; a log without a sensor column has one, ""
  std::vector<std::string> id_names;      ///< [label] if identities are names; empty if they are numbers
  bool has_labels = false;
  std::vector<core::Nanoseconds> lost_ns;  ///< the vehicle was carried after each of them, before the next scan
  std::vector<OwnFix> fixes;
  std::vector<core::TruePose> true_poses;
  std::vector<core::TruePosition> true_positions;
  std::vector<core::TrueLandmark> true_landmarks;
  std::vector<std::string> remarks;  ///< what was sorted, left out or not used, one sentence each
};

/// Whether `path` looks like one: a folder with odometry.csv, detections.csv or vehicle.toml, or a JSON Lines file.
bool is_own_log(const std::filesystem::path& path);

/// The vehicle.toml of a log: in the folder, or beside the JSON Lines file. Empty when there is none.
std::filesystem::path vehicle_beside(const std::filesystem::path& log);

/// Reads a folder with odometry.csv and detections.csv, and lost.csv, fixes.csv, truth_poses.csv, truth_landmarks.csv
/// if they exist, or a JSON Lines file. Columns are recognised by name, with units as suffixes (docs/your_own_log.md).
/// Rows out of order by less than a second are sorted. Throws core::InputError naming file:line:column for anything
/// else that cannot be used. Test: logs/own/own_log_test.cpp, logs/own/own_log_refusals_test.cpp.
OwnLog read_own_log(const std::filesystem::path& path);

/// The events of the log as this vehicle makes them: odometry between two scans or fixes as one increment, split at
/// them in proportion to time, and everything in the vehicle frame. Throws core::InputError for noise that neither the
/// log nor the vehicle states, a sensor that the vehicle does not have, or clocks that do not overlap. Remarks go to
/// Recording::remarks. Test: logs/own/own_recording_test.cpp.
core::Recording make_recording(const OwnLog& log, const Vehicle& vehicle);

}  // namespace helixnav::logs
