// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/own_lines.hpp"

#include <fstream>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/logs/own_log.hpp"
#include "helixnav/logs/vehicle.hpp"
#include "temporary_folder.hpp"

namespace helixnav::logs {
namespace {

core::Odometry moved_at(core::Nanoseconds t_ns, double x_m) {
  core::Odometry odometry;
  odometry.t_ns = t_ns;
  odometry.T_before_after = {x_m, 0.1 / 3.0, 0.01};
  odometry.covariance << 0.01, 0.001, 0.0, 0.001, 0.02, 0.0003, 0.0, 0.0003, 1.0 / 3.0 * 1e-3;
  return odometry;
}

/// A drive with a scan of each kind, a class, a size, an identity, an empty scan and a time at which it was carried.
core::Recording drive_with_everything() {
  core::Recording recording;
  recording.name = "everything";
  core::Scan scan;
  scan.T_robot_sensor = {0.5, -0.1, 0.02};
  scan.field_of_view = {1.0, 25.0, -1.5, 1.5, 30.0};
  scan.t_ns = 1'000'000'000;
  scan.observations = {core::make_range_bearing(10.0 / 3.0, 0.3, 0.1, 0.02),
                       core::make_cartesian({4.0, 1.0}, Eigen::Matrix2d{{0.04, 0.01}, {0.01, 0.09}}),
                       core::make_bearing(-0.2, 0.05)};
  scan.observations[0].appearance.name = core::ClassName("yellow cone");
  scan.observations[0].appearance.class_error = 0.03;
  scan.observations[1].appearance.size_m = 0.25;
  scan.observations[1].appearance.sigma_size_m = 0.02;
  recording.events = {moved_at(1'000'000'000, 0.5), scan, core::Lost{1'200'000'000}, moved_at(1'500'000'000, 0.25)};
  scan.t_ns = 1'500'000'000;
  scan.observations.clear();
  recording.events.emplace_back(scan);
  recording.labels = {{7, core::no_label, 8}, {}};
  recording.true_landmarks = {{7, {3.0, 1.0}}};
  return recording;
}

core::Recording read_back(const core::Recording& recording) {
  const testing::TemporaryFolder folder;
  const auto lines = folder.write("log.jsonl", own_lines(recording));
  return make_recording(read_own_log(lines), read_vehicle_text(vehicle_of_lines(recording), "vehicle.toml"));
}

TEST(OwnLines, ReadBackAreTheSameScans) {
  const core::Recording recording = drive_with_everything();
  const core::Recording again = read_back(recording);
  std::vector<core::Scan> scans;
  bool lost = false;
  for (const core::Event& event : again.events) {
    if (const auto* scan = std::get_if<core::Scan>(&event)) scans.push_back(*scan);
    lost = lost || std::holds_alternative<core::Lost>(event);
  }
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_TRUE(lost);
  const auto& before = std::get<core::Scan>(recording.events[1]);
  EXPECT_EQ(scans[0].T_robot_sensor.vector(), before.T_robot_sensor.vector());
  EXPECT_EQ(scans[0].field_of_view.reach_m, 30.0);
  EXPECT_EQ(scans[0].field_of_view.max_range_m, 25.0);
  ASSERT_EQ(scans[0].observations.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(scans[0].observations[i].z, before.observations[i].z);
    EXPECT_TRUE(scans[0].observations[i].R.isApprox(before.observations[i].R, 1e-15));
    EXPECT_EQ(scans[0].observations[i].appearance.name, before.observations[i].appearance.name);
    EXPECT_EQ(scans[0].observations[i].appearance.size_m, before.observations[i].appearance.size_m);
    EXPECT_EQ(scans[0].observations[i].appearance.sigma_size_m, before.observations[i].appearance.sigma_size_m);
  }
  EXPECT_EQ(scans[0].observations[0].appearance.class_error, 0.03);
  EXPECT_EQ(again.labels, recording.labels);
  EXPECT_TRUE(scans[1].observations.empty());
}

/// Motion between two scans with one time stamp, a scan at the same time as another, and one whose clock went back.
TEST(OwnLines, AreReadInTheirOrderWhereTimesAreTheSame) {
  core::Recording recording;
  core::Scan scan;
  scan.t_ns = 1'000'000'000;
  scan.observations = {core::make_range_bearing(3.0, 0.3, 0.1, 0.02)};
  scan.field_of_view = {1.0, 25.0, -1.5, 1.5, 30.0};
  recording.events = {moved_at(scan.t_ns, 0.5), scan, moved_at(scan.t_ns, 0.25), scan, scan};
  scan.t_ns -= 5;
  recording.events.insert(recording.events.end(), {moved_at(scan.t_ns, 0.125), scan});
  EXPECT_EQ(tell_times_apart(recording), 5u);
  std::vector<core::Nanoseconds> times;
  for (const core::Event& event : recording.events) times.push_back(core::time_of(event) - 1'000'000'000);
  EXPECT_EQ(times, (std::vector<core::Nanoseconds>{0, 0, 1, 1, 2, 3, 3}));
  EXPECT_EQ(tell_times_apart(recording), 0u);
  std::vector<double> moved_m;
  double since_scan_m = 0.0;
  for (const core::Event& event : read_back(recording).events) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) since_scan_m += odometry->T_before_after.x_m;
    if (std::holds_alternative<core::Scan>(event)) moved_m.push_back(std::exchange(since_scan_m, 0.0));
  }
  ASSERT_EQ(moved_m.size(), 4u);
  EXPECT_NEAR(moved_m[1], 0.25, 1e-9);
  EXPECT_NEAR(moved_m[2] + moved_m[3], 0.125, 1e-3) << "divided at the scan, along the arc";
}

TEST(OwnLines, SeveralSensorsHaveNoNamesInThem) {
  core::Recording recording = drive_with_everything();
  std::get<core::Scan>(recording.events.back()).T_robot_sensor.x_m += 1.0;
  EXPECT_THROW(vehicle_of_lines(recording), core::InputError);
}

}  // namespace
}  // namespace helixnav::logs
