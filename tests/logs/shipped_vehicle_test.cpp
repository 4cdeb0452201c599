// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/shipped_vehicle.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "input_error.hpp"
#include "temporary_folder.hpp"

namespace helixnav::logs {
namespace {

using testing::input_error_of;

TEST(ShippedVehicle, EachIsReadAndHasAName) {
  const std::vector<std::string> names = shipped_vehicle_names();
  EXPECT_EQ(names, (std::vector<std::string>{"car_park", "dlr", "plaza", "victoria_park"}));
  for (const std::string& name : names) {
    const Vehicle vehicle = shipped_vehicle(name);
    EXPECT_FALSE(vehicle.name.empty()) << name;
    EXPECT_EQ(vehicle.text, shipped_vehicle_text(name));
    EXPECT_EQ(vehicle.sensors.size(), 1u) << name;
  }
}

TEST(ShippedVehicle, OfEachFormatThatHasOneShips) {
  for (const LogFormat format : {LogFormat::acfr_ascii, LogFormat::victoria_park_mat, LogFormat::car_park_mat,
                                 LogFormat::plaza, LogFormat::dlr}) {
    ASSERT_TRUE(shipped_vehicle_of(format)) << name_of(format);
    EXPECT_NO_THROW(shipped_vehicle(*shipped_vehicle_of(format))) << name_of(format);
  }
  EXPECT_FALSE(shipped_vehicle_of(LogFormat::own));
  EXPECT_FALSE(shipped_vehicle_of(LogFormat::g2o));
}

TEST(ShippedVehicle, IsFoundByNameUnlessAFileIsCalledSo) {
  EXPECT_EQ(find_vehicle("plaza").name, "CMU Plaza");
  const testing::TemporaryFolder folder;
  const auto file = folder.write("mine.toml", "name = \"mine\"\n");
  EXPECT_EQ(find_vehicle(file.string()).name, "mine");
}

TEST(ShippedVehicle, WrongNameIsToldTheNearestAndAllThatShip) {
  const std::string message = input_error_of([] { find_vehicle("victoria_prk"); });
  EXPECT_NE(message.find("did you mean 'victoria_park'?"), std::string::npos) << message;
  EXPECT_NE(message.find("car_park, dlr, plaza, victoria_park"), std::string::npos) << message;
  const std::string of_file = input_error_of([] { find_vehicle("no.toml"); });
  EXPECT_NE(of_file.find("no.toml: expected a file that can be read"), std::string::npos) << of_file;
}

// The library's defaults equal those in the files, so that a program without files navigates in the same way.
TEST(ShippedVehicle, SaysOfTheTrucksWhatTheLibraryAssumes) {
  const RecordingSettings settings;
  for (const auto& [name, truck] :
       {std::pair{"victoria_park", settings.victoria_park}, {"car_park", settings.car_park}}) {
    const Vehicle vehicle = shipped_vehicle(name);
    const OdometryModel& odometry = vehicle.odometry;
    EXPECT_EQ(odometry.wheelbase_m, truck.geometry.wheelbase_m);
    EXPECT_EQ(odometry.encoder_offset_m, truck.geometry.encoder_offset_m);
    EXPECT_EQ(odometry.scale, truck.speed_scale);
    EXPECT_EQ(odometry.steering_scale, truck.steering_scale);
    EXPECT_EQ(odometry.steering_offset_rad, truck.steering_offset_rad);
    EXPECT_EQ(odometry.sigma_v_mps, truck.noise.sigma_speed_mps);
    EXPECT_EQ(odometry.sigma_steering_rad, truck.noise.sigma_steering_rad);
    EXPECT_EQ(odometry.sigma_sideways_m_per_sqrt_m.value_or(0.0), truck.sigma_sideways_m_per_sqrt_m);
    const SensorModel& laser = vehicle.sensors.at(0);
    EXPECT_EQ(laser.T_vehicle_sensor.vector(), truck.T_robot_laser.vector());
    EXPECT_EQ(laser.delay_s, truck.laser_delay_s);
    EXPECT_EQ(laser.sigma_range_m, truck.sigma_range_m);
    EXPECT_EQ(laser.sigma_bearing_rad, truck.sigma_bearing_rad);
    EXPECT_EQ(laser.reliable_range_m, truck.view_range_m);
    EXPECT_EQ(laser.reach_m, truck.reach_m);
    const bool trees = truck.detector == AcfrSettings::Detector::trees;
    EXPECT_EQ(laser.min_range_m, trees ? truck.trees.min_range_m : 0.0);
  }
}

TEST(ShippedVehicle, SaysOfPlazaWhatTheLibraryAssumes) {
  const PlazaSettings settings;
  const Vehicle vehicle = shipped_vehicle("plaza");
  EXPECT_EQ(vehicle.odometry.sigma_along_m_per_sqrt_m, settings.sigma_distance_m_per_sqrt_m);
  EXPECT_EQ(vehicle.odometry.sigma_sideways_m_per_sqrt_m, settings.sigma_sideways_m_per_sqrt_m);
  EXPECT_EQ(vehicle.odometry.sigma_heading_rad_per_sqrt_m, settings.sigma_heading_rad_per_sqrt_m);
  EXPECT_EQ(vehicle.sensors.at(0).sigma_range_m, settings.sigma_range_m);
}

}  // namespace
}  // namespace helixnav::logs
