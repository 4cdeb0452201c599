// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <optional>

#include <Eigen/Core>

#include "helixnav/core/recording.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::logs {

/// Calibration of the camera of the DLR robot: a .cam file (dlr_kurlbaum2009 §3.3.1, Figure 11).
struct DlrCamera {
  using Matrix34 = Eigen::Matrix<double, 3, 4>;
  Matrix34 T_tcp_camera = Matrix34::Zero();
  Matrix34 T_robot_camera = Matrix34::Zero();  ///< "sensor2World", robot axes as in the file: X left, Y backward, Z up
  int mount_index = 0;
  Eigen::Vector2i size_px = Eigen::Vector2i::Zero();
  Eigen::Vector2d scale_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d offset_px = Eigen::Vector2d::Zero();
  std::array<double, 5> distortion{};  ///< a2, a3, b1, b2, b3 of eq (21)
};

/// Throws core::InputError naming file:line for a missing or unknown key, a wrong count of numbers, or a left 3×3 block
/// of sensor2World that is not a rotation to within 1e-3. Test: logs/dlr_camera_test.cpp.
DlrCamera read_dlr_camera(const std::filesystem::path& path);

/// Pose of the sensor relative to which bearings of vertical lines are measured, in the robot frame of this project (x
/// ahead, y left): the camera's position; no rotation, because the file gives bearings in the robot's axes.
core::Pose2 bearing_sensor_pose(const DlrCamera& camera);

/// Which direction of the robot a bearing of 0 refers to in LANDMARK_L lines.
enum class DlrBearingZero {
  from_file,  ///< `left` when the mean bearing of the file is closer to −π/2 than to 0, else `ahead`
  ahead,      ///< the paper's sample lines (Figure 10): 0 is straight ahead
  left,       ///< the paper's eq (13) in the axes of Figure 4: 0 is the file's X axis, ahead is −π/2
};

struct DlrOptions {
  std::optional<DlrCamera>
      camera;  ///< without: the .cam file of the folder if it has exactly one, else the paper's offset
  DlrBearingZero bearing_zero = DlrBearingZero::from_file;
};

/// Reads a DLR Spatial Cognition log (map.circles, map.lines): STEP, LANDMARK_C (old: LANDMARK), LANDMARK_L, comments,
/// lines continued by a backslash. The file's robot axes (X left, Y backward) become x ahead, y left; covariances are
/// rotated with them. One Odometry and one Scan per STEP, both at t = index of the STEP in seconds; circles are
/// Cartesian observations in the robot frame, lines are bearings from the camera. Labels are the file's identifiers, −1
/// is core::no_label; an observation with several is also in shared_observations. The format has no field of view: that
/// of circles is estimated from them (field_of_view.hpp), for a camera as for any other sensor. Image names, qualities
/// and picture coordinates are dropped. Run e, 1.6 MB: 0.05 s. Throws core::InputError naming file:line for an unknown
/// keyword, a field too few or too many, an invalid number, a missing identifier, an observation before the first STEP,
/// a covariance that is not positive definite, or circles and lines in one file. Test: logs/dlr_test.cpp.
core::Recording read_dlr(const std::filesystem::path& path, const DlrOptions& options = {});

/// Writes a recording in that format: circles (Cartesian or range and bearing, the latter to first order) or lines
/// (bearings; the position of the camera is not part of the format), identifiers from the labels, −1 without. One STEP
/// per scan; motion between scans is chained. Numbers are as short as reading back the same value allows; rotating the
/// axes there and back changes nothing. Throws core::InputError when the format cannot hold the recording (ranges
/// alone, fixes, circles with lines). Test: logs/dlr_test.cpp (round trip).
void write_dlr(const core::Recording& recording, const std::filesystem::path& path);

}  // namespace helixnav::logs
