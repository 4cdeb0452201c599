// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <string_view>

#include "dlr_frame.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/logs/dlr.hpp"
#include "input_files.hpp"
#include "text_cursor.hpp"

namespace helixnav::logs {
namespace {

DlrCamera::Matrix34 read_matrix(TextCursor& cursor, std::string_view what) {
  DlrCamera::Matrix34 matrix;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) matrix(row, column) = cursor.number_in_stream(what);
  }
  return matrix;
}

/// Reads the value of one key; false for an unknown key.
bool read_value(TextCursor& cursor, std::string_view key, DlrCamera& camera) {
  if (key == "sensor2Tcp:") {
    camera.T_tcp_camera = read_matrix(cursor, "12 numbers of sensor2Tcp");
  } else if (key == "sensor2World:") {
    camera.T_robot_camera = read_matrix(cursor, "12 numbers of sensor2World");
    const Eigen::Matrix3d R = camera.T_robot_camera.leftCols<3>();
    if (!(R * R.transpose()).isApprox(Eigen::Matrix3d::Identity(), 1e-3)) {
      cursor.fail("the left 3x3 block of sensor2World is not a rotation");
    }
  } else if (key == "mountIndex:") {
    camera.mount_index = static_cast<int>(cursor.integer_in_stream("mountIndex"));
  } else if (key == "width:") {
    camera.size_px.x() = static_cast<int>(cursor.integer_in_stream("width [px]"));
  } else if (key == "height:") {
    camera.size_px.y() = static_cast<int>(cursor.integer_in_stream("height [px]"));
  } else if (key == "scaleX:") {
    camera.scale_px.x() = cursor.number_in_stream("scaleX [px]");
  } else if (key == "scaleY:") {
    camera.scale_px.y() = cursor.number_in_stream("scaleY [px]");
  } else if (key == "offsetX:") {
    camera.offset_px.x() = cursor.number_in_stream("offsetX [px]");
  } else if (key == "offsetY:") {
    camera.offset_px.y() = cursor.number_in_stream("offsetY [px]");
  } else if (key == "coef:") {
    for (double& coefficient : camera.distortion) coefficient = cursor.number_in_stream("5 numbers of coef");
  } else {
    return false;
  }
  return true;
}

}  // namespace

DlrCamera read_dlr_camera(const std::filesystem::path& path) {
  std::string text = read_file(path);
  for (char& c : text) {
    if (std::string_view("[]{},").find(c) != std::string_view::npos) c = ' ';
  }
  TextCursor cursor(text, path.string());
  if (cursor.at_end() || cursor.word() != "SmRadialDistortedCamera") {
    cursor.fail("expected { SmRadialDistortedCamera at the beginning of a camera calibration");
  }
  DlrCamera camera;
  while (!cursor.at_end()) {
    const std::string key(cursor.word());
    if (!read_value(cursor, key, camera))
      cursor.fail("unknown key '" + key.substr(0, 24) + "' of a camera calibration");
  }
  if (camera.T_robot_camera.isZero()) cursor.fail("the camera calibration has no sensor2World");
  return camera;
}

core::Pose2 bearing_sensor_pose(const DlrCamera& camera) {
  const Eigen::Vector2d position_m = from_dlr_axes(Eigen::Vector2d(camera.T_robot_camera.col(3).head<2>()));
  return {position_m.x(), position_m.y(), 0.0};
}

}  // namespace helixnav::logs
