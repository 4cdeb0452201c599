// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/logs/own_stream.hpp"
#include "input_error.hpp"
#include "own_log_folder.hpp"

namespace helixnav::logs {
namespace {

/// The remarks on a log with these rows and scans at these times, and the number of scans left.
struct Overlap {
  std::string said;
  std::ptrdiff_t scans = 0;
};

Overlap overlap_of(const std::string& odometry, const std::vector<std::string>& times) {
  const OwnLogFolder log;
  log.write("odometry.csv", odometry);
  std::string detections = "t,range_m,bearing_deg\n";
  for (const std::string& t : times) detections += t + ",10,90\n";
  log.write("detections.csv", detections);
  const core::Recording recording = log.recording();
  Overlap overlap;
  for (const std::string& remark : recording.remarks) overlap.said += remark + '\n';
  const auto is_scan = [](const core::Event& event) { return std::holds_alternative<core::Scan>(event); };
  overlap.scans = std::count_if(recording.events.begin(), recording.events.end(), is_scan);
  return overlap;
}

const std::string speed_rows = "t,v,omega\n10,1,0\n11,1,0\n12,1,0\n";
const std::string increment_rows = "t,dx,dheading\n10,1,0\n11,1,0\n12,1,0\n";
const std::string pose_rows = "t,x,y,heading\n10,0,0,0\n11,1,0,0\n12,2,0,0\n";

TEST(OwnOverlap, SaysHowManyScansCameBeforeTheOdometryAndWhatIsMadeOfThem) {
  for (const std::string& odometry : {speed_rows, increment_rows, pose_rows}) {
    const Overlap overlap = overlap_of(odometry, {"3", "5.5", "9.5", "11"});
    EXPECT_EQ(overlap.said,
              "2 scans were taken before the odometry begins (3 to 5.5 s): the vehicle is taken to have stood until "
              "then\n");
    EXPECT_EQ(overlap.scans, 4);
  }
}

TEST(OwnOverlap, HoldsSpeedsAfterTheirEnd) {
  const Overlap overlap = overlap_of(speed_rows, {"11", "12.5", "14"});
  EXPECT_EQ(overlap.said,
            "1 scan was taken after the odometry ends (14 to 14 s): its last row is held until then, less certain the "
            "longer\n");
  EXPECT_EQ(overlap.scans, 3);
}

// Treated as from a vehicle at rest, they misplaced a moving one with certainty.
TEST(OwnOverlap, LeavesOutScansThatIncrementsAndPosesDoNotReach) {
  for (const std::string& odometry : {increment_rows, pose_rows}) {
    const Overlap overlap = overlap_of(odometry, {"11", "12.5", "14", "15"});
    EXPECT_EQ(overlap.said,
              "2 of 4 scans were taken after the odometry ends at 12 s (14 to 15 s); they are not used\n");
    EXPECT_EQ(overlap.scans, 2);
  }
}

/// Only the first of them is within the time of the odometry.
TEST(OwnOverlap, RefusesScansInMillisecondsBesideOdometryInSeconds) {
  std::vector<std::string> times{"12"};
  for (int i = 1; i <= 30; ++i) times.push_back(std::to_string(12000 + 250 * i));
  const std::string said = testing::input_error_of([&] { overlap_of(increment_rows, times); });
  EXPECT_NE(said.find("30 of 31 scans"), std::string::npos) << said;
  EXPECT_NE(said.find("t_ms milliseconds"), std::string::npos) << said;
}

TEST(OwnOverlap, IsTheSameOfAStream) {
  const OwnLogFolder log;
  log.write("vehicle.toml",
            "[odometry]\nsigma_along_m_per_sqrt_m = 0.02\n"
            "[[sensor]]\nreach_m = 40\nview_deg = [-90, 90]\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n");
  OwnStream stream(read_vehicle(log.folder.path() / "vehicle.toml"));
  for (int t = 10; t <= 12; ++t) {
    stream.take(R"({"odometry": {"t": )" + std::to_string(t) + R"(, "dx": 1, "dheading": 0}})",
                static_cast<std::size_t>(t));
  }
  stream.take(R"({"detections": [{"t": 12.5, "range": 10, "bearing": 1}]})", 13);
  stream.take(R"({"detections": [{"t": 14, "range": 10, "bearing": 1}]})", 14);
  const StreamedEvents end = stream.finish();
  ASSERT_EQ(end.refused.size(), 1U);
  EXPECT_EQ(end.refused[0].line, 14U);
  EXPECT_EQ(end.refused[0].key, "t");
  EXPECT_EQ(end.refused[0].why, "the odometry ended before the time of this scan, 14 s");
  EXPECT_EQ(end.lines, std::vector<std::size_t>{13});
}

/// A driver that has lost its odometry is not a parked vehicle.
TEST(OwnOverlap, TakesNoScanOfAStreamThatHasNoOdometry) {
  const OwnLogFolder log;
  log.write("vehicle.toml",
            "[[sensor]]\nreach_m = 40\nview_deg = [-90, 90]\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n");
  OwnStream stream(read_vehicle(log.folder.path() / "vehicle.toml"));
  for (std::size_t line = 1; line <= 3; ++line) {
    stream.take(R"({"detections": [{"t": )" + std::to_string(line) + R"(, "range": 10, "bearing": 1}]})", line);
  }
  const StreamedEvents end = stream.finish();
  EXPECT_TRUE(end.lines.empty());
  ASSERT_EQ(end.refused.size(), 3U);
  EXPECT_EQ(end.refused[0].why, "no line of odometry has come: nobody knows where this scan was taken, 1 s");
}

}  // namespace
}  // namespace helixnav::logs
