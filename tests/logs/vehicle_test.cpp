// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/vehicle.hpp"

#include <string>

#include <gtest/gtest.h>

#include "input_error.hpp"
#include "temporary_folder.hpp"

namespace helixnav::logs {
namespace {

using testing::input_error_of;

class VehicleFile : public ::testing::Test {
 protected:
  Vehicle read(const std::string& text) const { return read_vehicle(folder_.write("vehicle.toml", text)); }
  /// The message without the folder.
  std::string error(const std::string& text) const {
    const std::string message = input_error_of([&] { read(text); });
    const std::size_t at = message.find("vehicle.toml");
    return at == std::string::npos ? message : message.substr(at);
  }
  testing::TemporaryFolder folder_;
};

TEST_F(VehicleFile, TakesAnglesInDegreesOrRadians) {
  const Vehicle vehicle = read(
      "name = \"cart\"\n[odometry]\nsigma_heading_deg_per_sqrt_m = 180\nturn_bias_rad_per_s = 0.5\n"
      "[[sensor]]\nheading_deg = 90\nview_deg = [-135, 135]\nsigma_bearing_rad = 0.25\nreach_m = 40\n");
  EXPECT_EQ(vehicle.name, "cart");
  EXPECT_DOUBLE_EQ(*vehicle.odometry.sigma_heading_rad_per_sqrt_m, core::pi);
  EXPECT_DOUBLE_EQ(vehicle.odometry.turn_bias_radps, 0.5);
  ASSERT_EQ(vehicle.sensors.size(), 1u);
  EXPECT_DOUBLE_EQ(vehicle.sensors[0].T_vehicle_sensor.heading_rad, core::pi / 2);
  EXPECT_DOUBLE_EQ(*vehicle.sensors[0].max_bearing_rad, 0.75 * core::pi);
  EXPECT_DOUBLE_EQ(*vehicle.sensors[0].sigma_bearing_rad, 0.25);
}

TEST_F(VehicleFile, TakesAViewAcrossTheBack) {
  const Vehicle behind = read("[[sensor]]\nview_deg = [90, 270]\n");
  EXPECT_DOUBLE_EQ(*behind.sensors[0].min_bearing_rad, 0.5 * core::pi);
  EXPECT_DOUBLE_EQ(*behind.sensors[0].max_bearing_rad, 1.5 * core::pi);
  const Vehicle all_around = read("[[sensor]]\nview_deg = [0, 360]\n");
  EXPECT_DOUBLE_EQ(*all_around.sensors[0].min_bearing_rad, -core::pi);
  EXPECT_DOUBLE_EQ(*all_around.sensors[0].max_bearing_rad, core::pi);
}

TEST_F(VehicleFile, OfNothingTellsNothing) {
  const Vehicle vehicle = read("");
  EXPECT_TRUE(vehicle.sensors.empty());
  EXPECT_FALSE(vehicle.odometry.tells_noise());
}

TEST_F(VehicleFile, NamesThePlaceAndTheNearestKeyOfTheSection) {
  EXPECT_EQ(error("[odometry]\n  scal = 1\n"),
            "vehicle.toml:2:3: unknown key 'odometry.scal'; the nearest is 'odometry.scale'");
  EXPECT_EQ(error("[[sensor]]\nreach = 4\n"),
            "vehicle.toml:2:1: unknown key 'sensor.reach'; the nearest is 'sensor.reach_m'");
  EXPECT_EQ(error("[odometri]\n"), "vehicle.toml:1:2: unknown key 'odometri'; the nearest is 'odometry'");
}

TEST_F(VehicleFile, RefusesValuesOfTheWrongKindRangeOrTwice) {
  EXPECT_EQ(error("[odometry]\nscale = \"1\"\n"), "vehicle.toml:2:9: odometry.scale: expected a number, found text");
  EXPECT_EQ(error("[[sensor]]\nreach_m = -1\n"),
            "vehicle.toml:2:11: sensor.reach_m: expected a number from 0.001 to 100000, found -1");
  EXPECT_EQ(error("[[sensor]]\nsigma_range_m = nan\n"),
            "vehicle.toml:2:17: sensor.sigma_range_m: expected a number from 1e-09 to 10000, found nan");
  EXPECT_EQ(error("[[sensor]]\nheading_deg = 1\nheading_rad = 1\n"),
            "vehicle.toml:2:15: sensor.heading_deg: heading_rad is given, too; keep one");
  EXPECT_EQ(error("[[sensor]]\nview_deg = [90, -90]\n"),
            "vehicle.toml:2:12: sensor.view_deg: expected the smaller angle first");
  EXPECT_EQ(
      error("[[sensor]]\nview_deg = 270\n"),
      "vehicle.toml:2:12: sensor.view_deg: expected a list of two angles, from the right to the left, as [-90, 90]");
  EXPECT_EQ(error("[[sensor]]\nreach_m = 4\nreliable_range_m = 5\n"),
            "vehicle.toml:3:20: sensor.reliable_range_m: expected no more than reach_m");
  EXPECT_EQ(error("[[sensor]]\nreach_m = 4\n[[sensor]]\n").substr(0, 17), "vehicle.toml:1:1:");
  EXPECT_EQ(error("odometry = 3\n"), "vehicle.toml:1:12: odometry: expected a section [odometry], found a number");
}

TEST_F(VehicleFile, RefusesWhatIsNoToml) {
  EXPECT_EQ(error("[odometry\n").substr(0, 26), "vehicle.toml:1:10: no TOML");
  EXPECT_NE(input_error_of([&] { read_vehicle(folder_.path() / "none.toml"); }).find("none.toml: expected a file"),
            std::string::npos);
}

}  // namespace
}  // namespace helixnav::logs
