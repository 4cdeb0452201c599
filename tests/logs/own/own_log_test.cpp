// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/own_log.hpp"

#include <string>

#include <gtest/gtest.h>

#include "helixnav/logs/read_recording.hpp"
#include "own_log_folder.hpp"

namespace helixnav::logs {
namespace {

using Kind = OwnDetection::Kind;

OdometryKind kind_of(const std::string& header, const std::string& row) {
  const OwnLogFolder log;
  log.write("odometry.csv", header + "\n" + row + "\n");
  return log.read().odometry_kind;
}

TEST(OwnLog, KnowsFiveKindsOfOdometryByTheirColumns) {
  EXPECT_EQ(kind_of("t,dx_m,dy_m,dheading_rad", "0,1,0,0"), OdometryKind::increments);
  EXPECT_EQ(kind_of("t,v_mps,omega_degps", "0,1,0"), OdometryKind::velocities);
  EXPECT_EQ(kind_of("t,v_m_per_s,omega_rad_per_s", "0,1,0"), OdometryKind::velocities) << "as vehicle.toml writes them";
  EXPECT_EQ(kind_of("t,v_km_per_h,omega_deg_per_s", "0,1,0"), OdometryKind::velocities);
  EXPECT_EQ(kind_of("t,speed_kmh,steering_deg", "0,1,0"), OdometryKind::steering);
  EXPECT_EQ(kind_of("t,v_left_mps,v_right_mps", "0,1,0"), OdometryKind::wheels);
  EXPECT_EQ(kind_of("t,x_m,y_m,yaw_rad", "0,1,0,0"), OdometryKind::poses);
}

TEST(OwnLog, ReadsUnitsFromTheNamesOfColumns) {
  const OwnLogFolder log;
  log.write("odometry.csv", "Time [ms], Speed (km/h), yaw rate [deg/s]\n1500,3.6,180\n");
  const OwnLog read = log.read();
  ASSERT_EQ(read.odometry.size(), 1u);
  EXPECT_EQ(read.odometry[0].t_ns, 1'500'000'000);
  EXPECT_DOUBLE_EQ(read.odometry[0].value.x(), 1.0);
  EXPECT_DOUBLE_EQ(read.odometry[0].value.z(), core::pi);
}

TEST(OwnLog, ReadsNanosecondsOfUnixTimeToTheLastDigit) {
  const OwnLogFolder log;
  log.write("odometry.csv", "t_ns,v,omega\n1700000000123456789,1,0\n");
  EXPECT_EQ(log.read().odometry[0].t_ns, 1'700'000'000'123'456'789);
}

TEST(OwnLog, TakesEachRowOfDetectionsByTheCellsItFills) {
  const OwnLogFolder log;
  log.write("detections.csv", "t,range_m,bearing_rad,x_m,y_m,id\n0,10,1,,,3\n0,10,,,,\n0,,1,,,\n0,,,4,5,-1\n1,,,,,\n");
  const OwnLog read = log.read();
  ASSERT_EQ(read.detections.size(), 5u);
  const Kind expected[] = {Kind::range_bearing, Kind::range, Kind::bearing, Kind::cartesian, Kind::nothing};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(read.detections[i].kind, expected[i]) << i;
  EXPECT_TRUE(read.has_labels);
  EXPECT_EQ(read.detections[0].label, 3);
  EXPECT_EQ(read.detections[3].label, core::no_label);
}

TEST(OwnLog, NumbersIdentitiesThatAreNamesInTheirOrder) {
  const OwnLogFolder log;
  log.write("detections.csv", "t,bearing_deg,id\n0,10,\"church, old\"\n0,20,mast\n1,11,\"church, old\"\n");
  const OwnLog read = log.read();
  EXPECT_EQ(read.detections[0].label, 0);
  EXPECT_EQ(read.detections[1].label, 1);
  EXPECT_EQ(read.detections[2].label, 0);
  EXPECT_EQ(read.id_names, (std::vector<std::string>{"church, old", "mast"}));
}

TEST(OwnLog, SortsRowsWithinASecondAndCountsThem) {
  const OwnLogFolder log;
  log.write("odometry.csv", "t,v,omega\n0,1,0\n0.5,2,0\n0.25,3,0\n1,4,0\n");
  const OwnLog read = log.read();
  EXPECT_DOUBLE_EQ(read.odometry[1].value.x(), 3.0);
  ASSERT_EQ(read.remarks.size(), 1u);
  EXPECT_EQ(read.remarks[0], "odometry: 1 row out of order by less than a second, sorted");
}

TEST(OwnLog, LeavesOutDetectionsThatRepeatAnotherAndCountsThem) {
  const OwnLogFolder log;
  log.write("detections.csv", "t,range_m,bearing_deg\n0,10,1\n0,10,1\n0,10,2\n1,10,1\n");
  const OwnLog read = log.read();
  EXPECT_EQ(read.detections.size(), 3u);
  EXPECT_EQ(read.remarks.at(0), "detections: 1 row that repeat another, left out");
}

// Sent twice by a driver: it would have been driven twice.
TEST(OwnLog, LeavesOutIncrementsThatRepeatAnotherAndCountsThem) {
  const OwnLogFolder log;
  log.write("odometry.csv", "t,dx_m,dheading_rad\n0,0,0\n0.5,2,0.1\n0.5,2,0.1\n1,2,0.1\n");
  const OwnLog read = log.read();
  ASSERT_EQ(read.odometry.size(), 3u);
  EXPECT_EQ(read.odometry.back().t_ns, 1'000'000'000);
  EXPECT_EQ(read.remarks.at(0), "odometry: 1 row that repeat another, left out");
}

TEST(OwnLog, KeepsEqualIncrementsWhereSeveralShareOneTime) {
  const OwnLogFolder log;
  log.write("odometry.csv", "t,dx_m,dheading_rad\n0,0,0\n1,2,0.1\n1,2,0.1\n1,2,0.2\n2,2,0.1\n");
  EXPECT_EQ(log.read().odometry.size(), 5u);
  log.write("odometry.csv", "t,v,omega\n0,1,0\n0.5,2,0\n0.5,2,0\n1,4,0\n");
  EXPECT_EQ(log.read().odometry.size(), 4u) << "a speed may be said twice";
}

// Comparing row with row, 160 000 of them in eight scans took 24 s.
TEST(OwnLog, FindsWhatIsRepeatedInScansOfThousands) {
  const OwnLogFolder log;
  std::string rows = "t_s,range_m,bearing_deg\n";
  for (int i = 0; i < 20'000; ++i) rows += "0.5," + std::to_string(1.0 + 0.001 * (i * 7919 % 20'000)) + ",10\n";
  for (int i = 0; i < 100; ++i) rows += "0.5," + std::to_string(1.0 + 0.001 * i) + ",10\n";
  log.write("detections.csv", rows + "1.5,1.000000,10\n");
  const OwnLog read = log.read();
  EXPECT_EQ(read.remarks.at(0), "detections: 100 rows that repeat another, left out");
  ASSERT_EQ(read.detections.size(), 20'001U);
  EXPECT_DOUBLE_EQ(read.detections[1].z[0], 8.919) << "in the order of the rows";
}

TEST(OwnLog, TellsOfColumnsThatItDoesNotUse) {
  const OwnLogFolder log;
  log.write("detections.csv", "t,range_m,bearing_deg,quality,class\n0,10,1,7,oak\n");
  const OwnLog read = log.read();
  ASSERT_EQ(read.remarks.size(), 1u);
  EXPECT_NE(read.remarks[0].find("column quality is not used"), std::string::npos);
  EXPECT_EQ(read.detections.at(0).class_name.text(), "oak");
}

TEST(OwnLog, AsJsonLinesIsTheSameAsInTables) {
  const OwnLogFolder log;
  log.write("drive/vehicle.toml", "");
  const auto path = log.write("drive/log.jsonl",
                              "{\"odometry\": {\"t_s\": 0, \"v_mps\": 1, \"omega_radps\": 0}}\n"
                              "{\"detections\": [{\"t_s\": 0.5, \"range_m\": 10, \"bearing_deg\": 90},\n"
                              "{\"odometry\": {}}\n");
  EXPECT_NE(testing::input_error_of([&] { read_own_log(path); }).find("log.jsonl:2:"), std::string::npos);
  log.write("drive/log.jsonl",
            "{\"odometry\": [{\"t_s\": 0, \"v_mps\": 1, \"omega_radps\": 0}, {\"t_s\": 1, \"v_mps\": 1, "
            "\"omega_radps\": 0.1}]}\n"
            "{\"detections\": [{\"t_s\": 0.5, \"range_m\": 10, \"bearing_deg\": 90}, {\"t_s\": 0.5, \"range_m\": 20, "
            "\"bearing_deg\": -45}]}\n\n"
            "{\"odometry\": {\"t_s\": 2, \"v_mps\": 1, \"omega_radps\": 0}}\n"
            "{\"detections\": {\"t_s\": 1.5, \"range_m\": 10, \"bearing_deg\": 95}}\n");
  const OwnLog table = log.read(), lines = read_own_log(path);
  EXPECT_EQ(recognise(path), LogFormat::own);
  EXPECT_EQ(vehicle_beside(path), log.folder.path() / "drive/vehicle.toml");
  ASSERT_EQ(lines.odometry.size(), table.odometry.size());
  ASSERT_EQ(lines.detections.size(), table.detections.size());
  for (std::size_t i = 0; i < table.odometry.size(); ++i) EXPECT_EQ(lines.odometry[i].value, table.odometry[i].value);
  for (std::size_t i = 0; i < table.detections.size(); ++i) EXPECT_EQ(lines.detections[i].z, table.detections[i].z);
}

TEST(OwnLog, AsJsonLinesMayHaveScansThatSawNothing) {
  const OwnLogFolder log;
  const auto path =
      log.write("log.jsonl", "{\"odometry\": {\"t\": 0, \"v\": 1, \"omega\": 0}}\n{\"detections\": {\"t\": 1}}\n");
  EXPECT_EQ(read_own_log(path).detections.at(0).kind, Kind::nothing);
}

TEST(OwnLog, RangesBecomeLongerByTheOffsetOfTheSensorAndPointsAlongTheLineOfSight) {
  const OwnLogFolder log;
  const std::string sensor =
      "[odometry]\nsigma_along_m_per_sqrt_m = 0.02\n[[sensor]]\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n"
      "sigma_point_m = 0.1\nrange_scale = 2.0\nrange_offset_m = 0.15\n";
  log.write("vehicle.toml", sensor);
  const auto first = [&] {
    const core::Recording recording = log.recording();
    for (const core::Event& event : recording.events) {
      if (const auto* scan = std::get_if<core::Scan>(&event)) return scan->observations.at(0);
    }
    return core::Observation();
  };
  log.write("detections.csv", "t,range_m,bearing_deg\n0.5,10,90\n");
  EXPECT_DOUBLE_EQ(first().z[0], 5.15);
  log.write("detections.csv", "t,x,y\n0.5,6,-8\n");
  EXPECT_NEAR(first().z[0], 3.09, 1e-12);
  EXPECT_NEAR(first().z[1], -4.12, 1e-12);
  log.write("vehicle.toml", sensor + "x_m = 0\n");
  log.write("detections.csv", "t,x,y\n0.5,0,0\n");
  EXPECT_EQ(first().z[0], 0.0) << "a point at the sensor has no direction";
}

}  // namespace
}  // namespace helixnav::logs
