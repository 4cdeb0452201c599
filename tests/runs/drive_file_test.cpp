// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/drive_file.hpp"

#include <cstdint>
#include <fstream>
#include <limits>
#include <string>
#include <variant>

#include <gtest/gtest.h>
#include <boost/crc.hpp>

#include "helixnav/core/errors.hpp"
#include "helixnav/files/file.hpp"
#include "temporary_folder.hpp"

namespace helixnav::runs {
namespace {

core::Pose2 unwrapped(double x_m, double y_m, double heading_rad) {
  core::Pose2 pose;
  pose.x_m = x_m;
  pose.y_m = y_m;
  pose.heading_rad = heading_rad;
  return pose;
}

core::Scan scan_of_every_kind(core::Nanoseconds t_ns) {
  core::Scan scan;
  scan.t_ns = t_ns;
  scan.T_robot_sensor = unwrapped(0.3, -0.0, 0.1);
  scan.field_of_view.reach_m = 40.0;
  Eigen::Matrix2d R;
  R << 0.02, 0.01 / 3.0, 0.01 / 3.0, 0.05;
  scan.observations = {core::make_range_bearing(5.0, -1.0 / 3.0, 0.1, 0.02), core::make_cartesian({0.0, 1e-9}, R),
                       core::make_bearing(0.25, 0.01), core::make_range(7.0, 0.5)};
  scan.observations[1].appearance.name = core::ClassName("a class of twenty-three");
  scan.observations[1].appearance.class_error = 0.07;
  scan.observations[3].appearance.size_m = 0.4;
  scan.observations[3].appearance.sigma_size_m = 0.01;
  return scan;
}

FedDrive drive_of_every_kind() {
  FedDrive drive;
  drive.start.mean = unwrapped(1.0 / 3.0, -7.0, 3.0);
  drive.start.covariance.diagonal() << 1.0, 2.0, 0.1;
  core::Odometry odometry;
  odometry.T_before_after = unwrapped(0.1, 0.0, -0.02);
  const Eigen::Matrix3d root = Eigen::Matrix3d::Random();
  odometry.covariance = root * root.transpose();
  odometry.covariance = (0.5 * (odometry.covariance + odometry.covariance.transpose())).eval();
  core::AbsoluteFix fix;
  fix.t_ns = 30;
  fix.position_world_m = {4.0, 1e7};
  fix.antenna_robot_m = {0.0, 0.3};
  for (core::Nanoseconds t_ns = 10; t_ns <= 50; t_ns += 20) {
    odometry.t_ns = t_ns;
    drive.events.emplace_back(odometry);
    drive.events.emplace_back(scan_of_every_kind(t_ns));
    if (t_ns == 30) drive.events.emplace_back(fix);
  }
  drive.events.emplace_back(core::Lost{60});
  return drive;
}

void expect_equal(const core::Observation& a, const core::Observation& b) {
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.z, b.z);
  EXPECT_EQ(a.R, b.R);
  EXPECT_EQ(a.appearance.name, b.appearance.name);
  EXPECT_EQ(a.appearance.class_error, b.appearance.class_error);
  EXPECT_EQ(a.appearance.size_m, b.appearance.size_m);
  EXPECT_EQ(a.appearance.sigma_size_m, b.appearance.sigma_size_m);
}

void expect_equal(const core::Event& a, const core::Event& b) {
  ASSERT_EQ(a.index(), b.index());
  EXPECT_EQ(core::time_of(a), core::time_of(b));
  if (const auto* odometry = std::get_if<core::Odometry>(&a)) {
    EXPECT_EQ(odometry->T_before_after.vector(), std::get<core::Odometry>(b).T_before_after.vector());
    EXPECT_EQ(odometry->covariance, std::get<core::Odometry>(b).covariance);
  }
  if (const auto* fix = std::get_if<core::AbsoluteFix>(&a)) {
    EXPECT_EQ(fix->position_world_m, std::get<core::AbsoluteFix>(b).position_world_m);
    EXPECT_EQ(fix->covariance_m2, std::get<core::AbsoluteFix>(b).covariance_m2);
    EXPECT_EQ(fix->antenna_robot_m, std::get<core::AbsoluteFix>(b).antenna_robot_m);
  }
  const auto* scan = std::get_if<core::Scan>(&a);
  if (scan == nullptr) return;
  const auto& other = std::get<core::Scan>(b);
  EXPECT_EQ(scan->T_robot_sensor.vector(), other.T_robot_sensor.vector());
  EXPECT_EQ(scan->field_of_view.max_range_m, other.field_of_view.max_range_m);
  EXPECT_EQ(scan->field_of_view.reach_m, other.field_of_view.reach_m);
  ASSERT_EQ(scan->observations.size(), other.observations.size());
  for (std::size_t i = 0; i < scan->observations.size(); ++i)
    expect_equal(scan->observations[i], other.observations[i]);
}

class DriveFileTest : public ::testing::Test {
 protected:
  std::string path() const { return (folder_.path() / "drive.bin").string(); }
  FedDrive read(const std::string& bytes) const {
    std::ofstream(path(), std::ios::binary) << bytes;
    return read_drive(path());
  }
  std::string written(const FedDrive& drive) const {
    const std::string file = (folder_.path() / "written.bin").string();
    std::filesystem::remove(file);
    DriveFile writer(file, drive.start);
    for (const core::Event& event : drive.events) writer.add(event);
    writer.finish();
    return files::read_whole_file(file);
  }
  void expect_refused(const std::string& bytes, const std::string& because) const {
    try {
      read(bytes);
      ADD_FAILURE() << "was read: " << because;
    } catch (const core::InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind(path(), 0), 0u) << "names the file";
      EXPECT_NE(std::string(error.what()).find(because), std::string::npos) << error.what();
    }
  }

  testing::TemporaryFolder folder_;
};

TEST_F(DriveFileTest, GoesThereAndBackBitForBit) {
  const FedDrive drive = drive_of_every_kind();
  const FedDrive back = read(written(drive));
  EXPECT_EQ(back.start.mean.vector(), drive.start.mean.vector());
  EXPECT_EQ(back.start.covariance, drive.start.covariance);
  ASSERT_EQ(back.events.size(), drive.events.size());
  for (std::size_t i = 0; i < drive.events.size(); ++i) expect_equal(drive.events[i], back.events[i]);
  EXPECT_EQ(written(back), written(drive));
}

TEST_F(DriveFileTest, SaysWhatTheEndOfTheInputBroughtForth) {
  const FedDrive drive = drive_of_every_kind();
  EXPECT_EQ(read(written(drive)).before_end_of_input, drive.events.size());
  const std::string file = (folder_.path() / "ended.bin").string();
  DriveFile writer(file, drive.start);
  for (std::size_t i = 0; i < drive.events.size(); ++i) {
    if (i == 5) writer.end_input();
    writer.add(drive.events[i]);
  }
  writer.finish();
  const FedDrive back = read_drive(file);
  EXPECT_EQ(back.events.size(), drive.events.size());
  EXPECT_EQ(back.before_end_of_input, 5u);
}

TEST_F(DriveFileTest, EveryFlippedByteIsFound) {
  const std::string whole = written(drive_of_every_kind());
  for (std::size_t k = 0; k < whole.size(); ++k) {
    std::string flipped = whole;
    flipped[k] = static_cast<char>(flipped[k] ^ 0x10);
    std::ofstream(path(), std::ios::binary) << flipped;
    EXPECT_THROW(read_drive(path()), core::InputError) << "byte " << k;
  }
}

std::uint32_t crc_of(const std::string& bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

/// A name may not contain a zero byte; if it does, it comes from another program. Found by fuzzing.
TEST_F(DriveFileTest, AClassThatIsNoneIsRefusedThoughItsChecksumFits) {
  std::string bytes = written(drive_of_every_kind());
  const std::size_t name = bytes.find("a class of");
  ASSERT_NE(name, std::string::npos);
  const std::size_t start = written({drive_of_every_kind().start, {}, 0}).size();
  bytes[name + 1] = '\0';
  std::uint32_t size = 0;
  for (int k = 3; k >= 0; --k)
    size = (size << 8) | static_cast<unsigned char>(bytes[start + static_cast<std::size_t>(k)]);
  const std::uint32_t crc = crc_of(bytes.substr(start + 12, size));
  for (int k = 0; k < 4; ++k) bytes[start + 8 + static_cast<std::size_t>(k)] = static_cast<char>(crc >> (8 * k));
  expect_refused(bytes, "class name");
}

/// As a killed process leaves it: complete scans are read, with what came before them.
TEST_F(DriveFileTest, OfAFileThatWasCutWhatIsWholeIsRead) {
  const std::string whole = written(drive_of_every_kind());
  const std::string begun = written({drive_of_every_kind().start, {}, 0});
  std::size_t last = 0;
  for (std::size_t size = begun.size(); size <= whole.size(); ++size) {
    const FedDrive drive = read(whole.substr(0, size));
    EXPECT_GE(drive.events.size(), last);
    last = drive.events.size();
    const bool ends_with_scan = last == 0 || std::holds_alternative<core::Scan>(drive.events.back());
    EXPECT_TRUE(ends_with_scan || size == whole.size()) << size;
  }
  EXPECT_EQ(last, drive_of_every_kind().events.size());
  for (std::size_t size = 0; size < begun.size(); ++size) expect_refused(whole.substr(0, size), "cut short");
}

TEST_F(DriveFileTest, WhatIsNoneIsRefusedByName) {
  expect_refused("HELIXMAP and more", "does not begin with HELIXDRV");
  std::string other = written(drive_of_every_kind());
  other[8] = 2;
  expect_refused(other, "version 2 of drive.bin; this program reads version 1");
  FedDrive disordered = drive_of_every_kind();
  std::swap(disordered.events.front(), disordered.events.back());
  expect_refused(written(disordered), "an event before the one before it");
  FedDrive impossible = drive_of_every_kind();
  std::get<core::Odometry>(impossible.events.front()).T_before_after.x_m = std::numeric_limits<double>::quiet_NaN();
  expect_refused(written(impossible), "byte");
  EXPECT_THROW(read_drive((folder_.path() / "absent.bin").string()), core::InputError);
}

}  // namespace
}  // namespace helixnav::runs
