// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <gtest/gtest.h>

#include "own_log_folder.hpp"

namespace helixnav::logs {
namespace {

/// The remarks on the log with this file, one per line.
std::string remarks(const std::string& file, const std::string& text) {
  const OwnLogFolder log;
  log.write(file, text);
  std::string all;
  for (const std::string& remark : log.recording().remarks) all += remark + '\n';
  return all;
}

bool says(const std::string& all, const std::string& words) { return all.find(words) != std::string::npos; }

TEST(OwnDoubts, AreNoneAboutALogThatIsRight) { EXPECT_EQ(remarks("note.txt", ""), ""); }

TEST(OwnDoubts, TellMillisecondsTakenForSeconds) {
  EXPECT_TRUE(says(remarks("odometry.csv", "t,v,omega\n0,1,0\n50,1,0\n100,1,0\n"), "a row every 50 s"));
}

TEST(OwnDoubts, TellDegreesTakenForRadians) {
  EXPECT_TRUE(says(remarks("odometry.csv", "t,v,omega\n0,1,30\n1,1,30\n2,1,30\n"),
                   "3 of 3 rows turn by more than 6 rad/s; are the headings in degrees?"));
  EXPECT_TRUE(
      says(remarks("odometry.csv", "t,x,y,heading\n0,0,0,90\n1,0,0,92\n2,0,0,94\n"), "are the headings in degrees?"));
  std::string detections = "t,range_m,bearing_deg\n";
  for (int i = 0; i < 101; ++i) detections += "1,10," + std::to_string(0.01 * i) + "\n";
  EXPECT_TRUE(says(remarks("detections.csv", detections), "all 101 bearings lie within ±1 degrees"));
}

TEST(OwnDoubts, TellGapsWithTheirLengthAndPlace) {
  const std::string all = remarks("odometry.csv", "t,v,omega\n0,1,0\n0.1,1,0\n0.2,1,0\n5.2,1,0\n5.3,1,0\n");
  EXPECT_TRUE(says(all,
                   "1 gap longer than 1 s, the longest 5 s from 0.2 s on; the row before a gap is held through it, as "
                   "uncertain as its changes so far"))
      << all;
}

TEST(OwnDoubts, TellMissingRowsOfIncrements) {
  const auto rows = [](double over_gap_m) {
    std::string text = "t_s,dx_m,dy_m,dheading_rad\n";
    for (int i = 1; i <= 20; ++i) text += std::to_string(0.1 * i) + ",0.3,0,0\n";
    text += "32.1," + std::to_string(over_gap_m) + ",0,0\n";
    for (int i = 1; i <= 20; ++i) text += std::to_string(32.1 + 0.1 * i) + ",0.3,0,0\n";
    return text;
  };
  const std::string missing = remarks("odometry.csv", rows(0.3));
  EXPECT_TRUE(
      says(missing, "rows are missing from 2 s on for 30.1 s: the vehicle moves 0.3 m in that time, and 3 m/s before"))
      << missing;
  EXPECT_TRUE(says(remarks("odometry.csv", rows(90.0)),
                   "1 gap longer than 1 s, the longest 30.1 s from 2 s on; motion in it is spread"));
}

/// A drive at 3 m/s, a row every 0.1 s; row 20 covers the given distance.
std::string drive_with_jump(double jump_m) {
  std::string rows = "t_s,dx_m,dy_m,dheading_rad\n";
  for (int i = 0; i < 40; ++i) {
    rows += std::to_string(0.1 * i) + ',' + std::to_string(i == 20 ? jump_m : 0.3) + ",0,0\n";
  }
  return rows;
}

TEST(OwnDoubts, TellARowThatLeavesAllOthersBehind) {
  const std::string all = remarks("odometry.csv", drive_with_jump(50.0));
  EXPECT_TRUE(says(all,
                   "1 row is faster than ten times what 99 % of them are (3 m/s); at 2 s the vehicle moves 50 m at "
                   "500 m/s"))
      << all;
  EXPECT_EQ(remarks("odometry.csv", drive_with_jump(2.9)), "") << "less than ten times";
}

TEST(OwnDoubts, TellAJumpOfPosesAndOfVelocities) {
  std::string poses = "t,x,y,heading\n", velocities = "t,v,omega\n";
  for (int i = 0; i < 40; ++i) {
    poses += std::to_string(0.1 * i) + ',' + std::to_string(0.3 * i + (i >= 20 ? 50.0 : 0.0)) + ",0,0\n";
    velocities += std::to_string(0.1 * i) + (i == 20 ? ",60,0\n" : ",3,0\n");
  }
  EXPECT_TRUE(says(remarks("odometry.csv", poses), "at 2 s the vehicle moves 50.3 m"));
  EXPECT_TRUE(says(remarks("odometry.csv", velocities), "the vehicle moves 6 m at 60 m/s"));
}

TEST(OwnDoubts, TellAReachThatNoDetectionComesNear) {
  const auto with_reach = [](const std::string& reach_m) {
    return remarks("vehicle.toml", "[odometry]\nsigma_along_m_per_sqrt_m = 0.02\n[[sensor]]\nreach_m = " + reach_m +
                                       "\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n");
  };
  EXPECT_TRUE(says(with_reach("300"), "a reach of 300 m, and the farthest of 3 detections is at 20 m"));
  EXPECT_EQ(with_reach("190"), "");
}

TEST(OwnDoubts, TellAReachThreeTimesTheFarthestOfManyDetections) {
  std::string detections = "t_s,range_m,bearing_deg\n";
  for (int i = 0; i < 200; ++i)
    detections += std::to_string(1 + i / 100) + "," + std::to_string(5.0 + 0.1 * i) + ',' + std::to_string(i) + '\n';
  const OwnLogFolder log;
  log.write("detections.csv", detections);
  const auto with_reach = [&](const std::string& reach_m) {
    log.write("vehicle.toml", "[odometry]\nsigma_along_m_per_sqrt_m = 0.02\n[[sensor]]\nreach_m = " + reach_m +
                                  "\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n");
    std::string all;
    for (const std::string& remark : log.recording().remarks) all += remark + '\n';
    return all;
  };
  EXPECT_TRUE(says(with_reach("80"), "a reach of 80 m, and the farthest of 200 detections is at 24.9 m"));
  EXPECT_EQ(with_reach("70"), "");
}

TEST(OwnDoubts, TellNoiseComputedFromTheMeasuredRange) {
  const auto rows = [](double share, double constant_m) {
    std::string detections = "t,range_m,bearing_rad,sigma_range_m,sigma_bearing_rad\n";
    for (int i = 0; i < 200; ++i) {
      const double range_m = 5.0 + 0.05 * i;
      detections += std::to_string(0.05 * i) + ',' + std::to_string(range_m) + ',' + std::to_string(0.01 * i - 1.0) +
                    ',' + std::to_string(constant_m + share * range_m) + ",0.02\n";
    }
    return remarks("detections.csv", detections);
  };
  EXPECT_TRUE(says(rows(0.1, 0.0), "sigma_range is 10 % of the measured range")) << rows(0.1, 0.0);
  EXPECT_TRUE(says(rows(0.1, 0.0), "some 2 % too short"));
  EXPECT_FALSE(says(rows(0.02, 0.0), "of the measured range"));
  EXPECT_FALSE(says(rows(0.05, 0.5), "of the measured range"));
}

TEST(OwnDoubts, TellThatHardlyAnythingWasDetected) {
  EXPECT_TRUE(says(remarks("detections.csv", "t,range_m,bearing_deg\n0.5,10,90\n"), "detections: 1 in all of the log"));
  EXPECT_TRUE(says(remarks("detections.csv", "t,range_m,bearing_deg\n0.5,,\n1.5,,\n"), "detections: 0 in all"));
}

TEST(OwnDoubts, TellThatAllWasDetectedAtOnce) {
  EXPECT_TRUE(says(remarks("detections.csv", "t,range_m,bearing_deg\n0.5,10,90\n0.5,20,-45\n"), "all are of one time"));
}

TEST(OwnDoubts, TellTheVehicleOfAnotherRobot) {
  const std::string all = remarks("vehicle.toml",
                                  "[odometry]\nsigma_along_m_per_sqrt_m = 0.02\n"
                                  "[[sensor]]\nreach_m = 3\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n");
  EXPECT_TRUE(says(all, "3 of 3 detections (100 %) lie outside the reach and view that")) << all;
}

TEST(OwnDoubts, SayNothingOfAViewThatIsNotStated) {
  const OwnLogFolder log;
  std::string detections = "t,range_m,bearing_deg,sigma_range_m,sigma_bearing_deg\n";
  for (int i = 0; i < 200; ++i) {
    detections +=
        std::to_string(0.01 * i) + ',' + std::to_string(5.0 + 0.1 * i) + ',' + std::to_string(i - 100) + ",0.05,0.2\n";
  }
  log.write("detections.csv", detections);
  const auto with_sensor = [&](const std::string& sensor) {
    log.write("vehicle.toml", "[odometry]\nsigma_along_m_per_sqrt_m = 0.02\n" + sensor);
    std::string all;
    for (const std::string& remark : log.recording().remarks) all += remark + '\n';
    return all;
  };
  const auto with = [&](const std::string& keys) { return with_sensor("[[sensor]]\n" + keys + '\n'); };
  EXPECT_FALSE(says(with_sensor(""), "lie outside"));
  EXPECT_FALSE(says(with("reliable_range_m = 8"), "lie outside")) << "what is seen beyond is seen less reliably";
  EXPECT_FALSE(says(with("reach_m = 26"), "lie outside"));
  EXPECT_TRUE(says(with("reach_m = 26\nview_deg = [-50, 50]"), "lie outside"));
  const std::string silent = "[[sensor]]\nname = \"silent\"\nx_m = 1\n";
  const std::string stated = "[[sensor]]\nname = \"\"\nreach_m = 6\n";
  EXPECT_TRUE(says(with_sensor(stated + silent), "lie outside")) << "of one sensor, whatever another states";
}

}  // namespace
}  // namespace helixnav::logs
