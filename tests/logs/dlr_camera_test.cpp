// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <string>

#include "helixnav/logs/dlr.hpp"
#include "input_error.hpp"
#include "temporary_folder.hpp"

namespace helixnav::logs {
namespace {

const std::string good =
    "{ SmRadialDistortedCamera\n"
    "sensor2Tcp: [ 1, 0, 0, -0.08 ]\n[ 0, 0, 1, 0.14 ]\n[ 0, -1, 0, 0.05 ]\n"
    "sensor2World: [ -1, 0, 0, 0.02 ]\n[ 0, 0.5, -0.8660254, -0.08 ]\n[ 0, -0.8660254, -0.5, 1.5 ]\n"
    "mountIndex: 0\n"
    "width: 768 height: 288 scaleX: 460 scaleY: 230 offsetX: 384 offsetY: 144\n"
    "coef: { -0.06 -0.3 0.3 1.5 -0.5 }\n}\n";

TEST(DlrCamera, ReadsEveryField) {
  const helixnav::testing::TemporaryFolder folder;
  const DlrCamera camera = read_dlr_camera(folder.write("a.cam", good));
  EXPECT_EQ(camera.T_robot_camera(1, 2), -0.8660254);
  EXPECT_EQ(camera.T_tcp_camera(2, 3), 0.05);
  EXPECT_EQ(camera.size_px, Eigen::Vector2i(768, 288));
  EXPECT_EQ(camera.scale_px, Eigen::Vector2d(460, 230));
  EXPECT_EQ(camera.offset_px, Eigen::Vector2d(384, 144));
  EXPECT_EQ(camera.distortion[4], -0.5);
  EXPECT_EQ(bearing_sensor_pose(camera).vector(), Eigen::Vector3d(0.08, 0.02, 0.0));
}

TEST(DlrCamera, NamesFileAndLineOfWhatIsWrong) {
  const helixnav::testing::TemporaryFolder folder;
  const auto error = [&folder](const std::string& text) {
    const std::filesystem::path path = folder.write("a.cam", text);
    const std::string message = helixnav::testing::input_error_of([&] { read_dlr_camera(path); });
    return message.substr(message.find("a.cam"));
  };
  EXPECT_EQ(error("Camera\n").substr(0, 17), "a.cam:1: expected");
  EXPECT_EQ(error(good + "zoom: 3\n"), "a.cam:12: unknown key 'zoom:' of a camera calibration");
  std::string bent = good;
  bent.replace(bent.find("-0.8660254"), 10, "-0.7660254");
  EXPECT_NE(error(bent).find("the left 3x3 block of sensor2World is not a rotation"), std::string::npos);
  EXPECT_NE(error("{ SmRadialDistortedCamera\n width: 3\n}").find("has no sensor2World"), std::string::npos);
  EXPECT_NE(error(good.substr(0, 100)).find("a.cam:"), std::string::npos);
}

}  // namespace
}  // namespace helixnav::logs
