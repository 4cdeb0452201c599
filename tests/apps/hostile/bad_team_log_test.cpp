// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "temporary_folder.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// Two robots 4 m apart that see each other three times each, and landmarks 6 and 7.
std::string odometry_table() { return "# robot,t,v,w\n1,0.0,0.0,0.0\n1,4.0,0.0,0.0\n2,0.0,0.0,0.0\n2,4.0,0.0,0.0\n"; }

std::string measurements_table(bool see_each_other = true) {
  std::string text = "# robot,t,barcode,subject,range,bearing\n";
  for (const char* t : {"1.0", "2.0", "3.0"}) {
    text += std::string("1,") + t + ",63,6,2.0,0.1\n";
    if (see_each_other) text += std::string("1,") + t + ",14,2,4.0,0.0\n";
    text += std::string("2,") + t + ",25,7,1.5,0.3\n";
    if (see_each_other) text += std::string("2,") + t + ",5,1,4.0,3.0\n";
  }
  return text;
}

class TeamLog : public ::testing::Test {
 protected:
  void SetUp() override {
    write("odometry.csv", odometry_table());
    write("measurements.csv", measurements_table());
    write("landmarks_true.csv", "# s,x,y,sx,sy\n6,1.0,2.0,1e-4,1e-4\n7,3.0,2.0,1e-4,1e-4\n");
  }
  void write(const std::string& name, const std::string& text) { folder_.write("log/" + name, text); }

  Outcome replay(const Words& options = {}) const {
    Words words{"replay", (folder_.path() / "log").string(), "--unknown-starts", "--quiet", "--out", out().string()};
    words.insert(words.end(), options.begin(), options.end());
    return run(words);
  }
  fs::path out() const { return folder_.path() / "out"; }

  void is_refused_with(const std::string& message, const Words& options = {}) const {
    const Outcome outcome = replay(options);
    EXPECT_EQ(outcome.exit_code, 3) << message;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << "expected " << message << "\nfound " << outcome.err;
    EXPECT_FALSE(fs::exists(out())) << message;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(TeamLog, IsNavigatedWhereNothingIsWrong) {
  const Outcome outcome = replay();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(names_in(out()), (std::set<std::string>{"joins.csv", "map.csv", "report.html", "robot_1", "robot_2",
                                                    "sightings.csv", "summary.json"}));
  EXPECT_EQ(outcome.out.find("to itself"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("nan"), std::string::npos) << "without truth there is no error: " << outcome.out;
  EXPECT_NE(outcome.out.find("frame of robot 1: 2 landmarks, aligned"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.err.find("warning"), std::string::npos) << outcome.err;
}

TEST_F(TeamLog, OverwritesRobotsOfTheRunBeforeAndNothingElse) {
  ASSERT_EQ(replay().exit_code, 0);
  fs::copy(out() / "robot_2", out() / "robot_7");
  fs::create_directory(out() / "robot_notes");
  const Outcome outcome = replay({"--overwrite"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_FALSE(fs::exists(out() / "robot_7"));
  EXPECT_TRUE(fs::exists(out() / "robot_2"));
  EXPECT_TRUE(fs::exists(out() / "robot_notes"));
}

TEST_F(TeamLog, WithoutNamesIsToldHowManyLandmarksThereAre) {
  const Outcome outcome = replay({"--association", "unknown"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("frame of robot 1: 2 landmarks\n"), std::string::npos) << outcome.out;
}

TEST_F(TeamLog, GivesNoMapToGoOnFromAndSaysSo) {
  ASSERT_EQ(replay().exit_code, 0);
  for (const fs::path& run_folder : {out(), out() / "robot_1"}) {
    const Outcome outcome =
        run({"join", run_folder.string(), (out() / "robot_2").string(), "--out", (folder_.path() / "joined").string()});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_NE(outcome.err.find("The run of a team writes none"), std::string::npos) << outcome.err;
  }
}

TEST_F(TeamLog, WithATableMissingIsRefused) {
  for (const std::string name : {"measurements.csv", "odometry.csv"}) {
    const std::string text = text_of(folder_.path() / "log" / name);
    fs::remove(folder_.path() / "log" / name);
    is_refused_with(name + ": expected this file");
    write(name, text);
  }
}

TEST_F(TeamLog, OfClocksApartIsRefused) {
  write("measurements.csv", "1,100.5,63,6,2.0,0.1\n2,3.0,63,6,2.0,0.0\n");
  is_refused_with(
      "odometry.csv:2: the commands of robot 1 last from 0.000000 to 4.000000 s, and its sightings from 100.5");
}

TEST_F(TeamLog, WithASubjectOfNobodyIsRefused) {
  write("measurements.csv", measurements_table() + "2,3.5,77,21,1.0,0.0\n");
  is_refused_with("measurements.csv:14: subject 21 is neither");
}

TEST_F(TeamLog, WithARobotThatNeitherSeesNorIsSeenGoesOnWithoutIt) {
  write("measurements.csv", "1,0.5,63,6,2.0,0.1\n");
  is_refused_with("log: robot 2 has no sightings, and no other sees it: choose others (--robots N,N)",
                  {"--robots", "1,2"});
  const Outcome outcome = replay();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: robot 2 is left out: it has no sightings"), std::string::npos) << outcome.err;
  EXPECT_TRUE(fs::exists(out() / "robot_1"));
  EXPECT_FALSE(fs::exists(out() / "robot_2"));
}

TEST_F(TeamLog, WithoutAnySightingIsRefused) {
  write("measurements.csv", "# robot,t,barcode,subject,range,bearing\n");
  is_refused_with("log: robot 1 has no sightings, and no other sees it");
}

TEST_F(TeamLog, WithARobotThatSeesNothingButIsSeenIsNavigated) {
  write("measurements.csv", "1,0.5,63,6,2.0,0.1\n1,1.0,14,2,4.0,0.0\n1,2.0,14,2,4.0,0.0\n");
  const Outcome outcome = replay();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(out() / "robot_2"));
}

TEST_F(TeamLog, WhoseCommandsStopIsRemarkedOn) {
  std::string commands;
  for (int k = 0; k < 40; ++k) commands += "1," + std::to_string(0.1 * k) + ",0.0,0.0\n";
  for (const char* t : {"0.0", "0.1", "0.2", "0.3", "20.0"}) commands += std::string("2,") + t + ",0.0,0.0\n";
  write("odometry.csv", commands);
  const Outcome outcome = replay();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("robot 2 has no command from 0.300000 to 20.000000 s"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("robot 1 has no command"), std::string::npos) << outcome.err;
}

/// Robots that stand for 40 s. Of landmarks 6 to 9, the first sees one every 0.4 s.
class StandingTeam : public TeamLog {
 protected:
  /// `bearing_rad`: by how much sighting k of the first robot is off.
  void see(const std::function<double(int)>& range_m, const std::function<double(int)>& bearing_rad) {
    write("odometry.csv", "1,0.0,0.0,0.0\n1,40.0,0.0,0.0\n2,0.0,0.0,0.0\n2,40.0,0.0,0.0\n");
    std::string text = "2,1.0,5,1,4.0,0.0\n";
    for (int k = 0; k < 96; ++k) {
      const int subject = 6 + k % 4;
      text += "1," + std::to_string(0.4 * (k + 1)) + "," + std::to_string(60 + subject) + "," +
              std::to_string(subject) + "," + std::to_string(2.0 + range_m(k)) + "," +
              std::to_string(0.4 * (k % 4) + bearing_rad(k)) + "\n";
    }
    write("measurements.csv", text);
    write("landmarks_true.csv", "6,2.0,0.0,1e-4,1e-4\n7,1.8,0.8,1e-4,1e-4\n8,1.4,1.4,1e-4,1e-4\n9,0.7,1.9,1e-4,1e-4\n");
  }
  Outcome replay_precise() const {
    return replay({"--mrclam.sigma_range_m", "0.1", "--mrclam.sigma_bearing_rad", "0.02"});
  }
};

TEST_F(StandingTeam, OfTheAssumedNoiseIsNotWarnedOf) {
  see([](int k) { return k / 4 % 2 == 0 ? 0.1 : -0.1; }, [](int k) { return k / 8 % 2 == 0 ? 0.02 : -0.02; });
  const Outcome outcome = replay_precise();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err.find("warning"), std::string::npos) << outcome.err;
}

TEST_F(StandingTeam, WithInnovationsLargerThanAssumedIsWarnedOf) {
  see([](int k) { return k / 4 % 2 == 0 ? 0.2 : -0.2; }, [](int k) { return k / 8 % 2 == 0 ? 0.04 : -0.04; });
  const Outcome outcome = replay_precise();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("robot 1: its sightings are farther from where they are expected"), std::string::npos)
      << outcome.err;
}

TEST_F(StandingTeam, ThatWasTurnedForAWhileIsWarnedOf) {
  see([](int) { return 0.0; }, [](int k) { return k >= 60 && k < 72 ? 2.0 : 0.0; });
  const Outcome outcome = replay_precise();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("robot 1: from 24.4 to 28.8 s all of its 12 sightings of 4 landmarks were refused"),
            std::string::npos)
      << outcome.err;
}

/// Landmark 6 is seen at two places alternately under one name.
TEST_F(TeamLog, OfWhichMuchIsRefusedIsWarnedOf) {
  std::string text;
  for (int k = 1; k < 80; ++k) {
    const std::string t = std::to_string(0.05 * k);
    text += "1," + t + (k % 3 == 0 ? ",63,6,6.0,1.5\n" : ",63,6,2.0,0.1\n") + "2," + t + ",25,7,1.5,0.3\n";
  }
  write("measurements.csv", text);
  const Outcome outcome = replay();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: robot 1: 26 of its 79 sightings"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("warning: robot 2"), std::string::npos) << outcome.err;
}

/// One in three robot sightings is wrong; the landmark sightings, which are far more numerous, are right.
TEST_F(TeamLog, OfRobotsThatContradictOneAnotherIsWarnedOf) {
  std::string text;
  for (int k = 1; k < 80; ++k) {
    const std::string t = std::to_string(0.05 * k);
    text += "1," + t + ",63,6,2.0,0.1\n2," + t + ",25,7,1.5,0.3\n";
    const std::string range = k % 9 == 0 ? "9.0" : "4.0";
    if (k % 3 == 0) text += "1," + t + ",14,2," + range + ",0.0\n2," + t + ",5,1," + range + ",3.0\n";
  }
  write("measurements.csv", text);
  const Outcome outcome = replay();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: robots 1 and 2: 16 of their 52 sightings of each other"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(outcome.err.find("warning: robot 1:"), std::string::npos) << outcome.err;
}

TEST_F(TeamLog, OfWhichATableWasCutIsRefusedAsCut) {
  // gzip of "1,1.0,63,6,2.0,0.1\n" without its last eight bytes.
  const std::string packed("\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\x03", 10);
  fs::remove(folder_.path() / "log" / "measurements.csv");
  write("measurements.csv.gz", packed);
  is_refused_with("measurements.csv.gz: expected a whole gzip file, found one that was cut");
}

TEST_F(TeamLog, IsForReplayAlone) {
  const std::string log = (folder_.path() / "log").string();
  for (const Words& words :
       {Words{"check", log}, Words{"smooth", log, "--out", out().string()}, Words{"associate", log}}) {
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 3) << words[0];
    EXPECT_NE(outcome.err.find("a log of several robots"), std::string::npos) << words[0] << ": " << outcome.err;
  }
}

TEST_F(TeamLog, WithARobotTwiceIsRefused) {
  write("odometry.csv", odometry_table() + "1,5.0,0.0,0.0\n");
  is_refused_with("odometry.csv:6: robot 1 is here a second time");
}

TEST_F(TeamLog, IsRefusedToWhoAsksForRobotsTwiceOrForOneThatIsNotThere) {
  is_refused_with("twice", {"--robots", "1,1"});
  is_refused_with("no robot 4", {"--robots", "4"});
}

TEST_F(TeamLog, IsRefusedToWhoNamesNoRobot) {
  for (const char* robots : {"", "one", "1,-2", "1,,2", "1,", ",1"}) {
    const Outcome outcome = replay({"--robots", robots});
    EXPECT_EQ(outcome.exit_code, 2) << robots;
    EXPECT_NE(outcome.err.find("expected numbers of robots, as 1,3, found '"), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(out()));
  }
}

/// The same robots in the original files.
class TeamDatFiles : public TeamLog {
 protected:
  void SetUp() override {
    write("Barcodes.dat", "1 5\n2 14\n6 63\n7 25\n");
    write("Landmark_Groundtruth.dat", "6 1.0 2.0 1e-4 1e-4\n7 3.0 2.0 1e-4 1e-4\n");
    for (const std::string robot : {"Robot1", "Robot2"}) {
      write(robot + "_Odometry.dat", "0.0 0.0 0.0\n4.0 0.0 0.0\n");
      write(robot + "_Measurement.dat", "1.0 63 2.0 0.1\n2.0 25 1.5 0.3\n");
    }
  }
};

TEST_F(TeamDatFiles, OfWhichOneIsMissingNameIt) {
  EXPECT_EQ(replay().err, "");
  fs::remove(folder_.path() / "log" / "Robot2_Odometry.dat");
  const Outcome outcome = replay({"--overwrite"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: robot 2 is left out: Robot2_Measurement.dat is there, and "), std::string::npos);
  EXPECT_NE(outcome.err.find("Robot2_Odometry.dat is missing"), std::string::npos) << outcome.err;
  EXPECT_EQ(replay({"--overwrite", "--robots", "1"}).err, "") << "by choice";
}

TEST_F(TeamDatFiles, OfRobotsBeyondFiveAreNamed) {
  write("Robot7_Odometry.dat", "0.0 0.0 0.0\n4.0 0.0 0.0\n");
  const Outcome outcome = replay();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: Robot7_Odometry.dat is left out: robots have the numbers 1 to 5"),
            std::string::npos)
      << outcome.err;
}

TEST_F(TeamDatFiles, WithoutMeasurementsOfARobotAreRefusedByName) {
  fs::remove(folder_.path() / "log" / "Robot2_Measurement.dat");
  is_refused_with("Robot2_Measurement.dat: expected this file, found none");
}

TEST_F(TeamDatFiles, WithoutABarcodeAreRefused) {
  for (const char* text : {"", "# subject barcode\n"}) {
    write("Barcodes.dat", text);
    is_refused_with("Barcodes.dat: expected rows of a subject and its barcode, found none");
  }
}

TEST_F(TeamLog, WithoutTrueStartsAsksForUnknownOnes) {
  const Outcome outcome = run({"replay", (folder_.path() / "log").string(), "--quiet", "--out", out().string()});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("--unknown-starts"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(out()));
}

TEST_F(TeamLog, OfRobotsThatNothingTiesLeavesEachItsFrameAndSaysSo) {
  write("measurements.csv", measurements_table(false));
  const Outcome outcome = replay();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("in the frame of robot 2, which it has to itself"), std::string::npos) << outcome.out;
  const auto summary = nlohmann::json::parse(text_of(out() / "summary.json"));
  EXPECT_EQ(summary["joins"], 0);
  for (const auto& robot : summary["robots"]) {
    EXPECT_EQ(robot["component"], robot["robot"]);
    EXPECT_EQ(robot["alone"], true);
  }
  EXPECT_NE(text_of(out() / "report.html").find("to itself"), std::string::npos);
  EXPECT_EQ(complete_lines(out() / "joins.csv"), 1u);
}

}  // namespace
}  // namespace helixnav::apps
