// SPDX-License-Identifier: BSD-3-Clause
// --start end without identities: the previous drive is driven again and continued.
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "helixnav/core/random.hpp"
#include "program.hpp"
#include "temporary_folder.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

class DriveAgain : public ::testing::Test {
 protected:
  fs::path folder(const std::string& name) const { return folder_.path() / name; }
  Outcome simulated(const std::vector<std::string>& words, const std::string& out) const {
    std::vector<std::string> all{"simulate", "large-loop-changed", "--seed", "7",
                                 "--quiet",  "--overwrite",        "--out",  folder(out)};
    all.insert(all.end(), words.begin(), words.end());
    return run(all);
  }
  void expect_same_run(const std::string& one, const std::string& other, const std::string& where) const {
    for (const char* name : {"trajectory.tum", "trajectory_final.tum", "associations.csv", "decisions.csv",
                             "merges.csv", "clouds.csv", "map.csv", "map.bin", "drive.bin"}) {
      ASSERT_TRUE(fs::exists(folder(one) / name)) << name;
      EXPECT_TRUE(text_of(folder(one) / name) == text_of(folder(other) / name)) << name << ", " << where;
    }
  }

  testing::TemporaryFolder folder_;
};

/// A drive of 254 s; the search is open from 178.5 to 193.5 s.
TEST_F(DriveAgain, AtTwentyInstantsItIsAsIfThereHadBeenNoInterruption) {
  ASSERT_EQ(simulated({}, "whole").exit_code, 0);
  core::RandomStream random(20, "interruptions");
  std::vector<double> instants_s{178.4, 186.2, 192.9};
  while (instants_s.size() < 20) instants_s.push_back(random.uniform(1.0, 253.0));
  for (const double instant_s : instants_s) {
    const std::string until = std::to_string(instant_s);
    ASSERT_EQ(simulated({"--until", until}, "first").exit_code, 0);
    const Outcome gone_on = simulated({"--map", folder("first"), "--start", "end"}, "gone_on");
    ASSERT_EQ(gone_on.exit_code, 0) << gone_on.err;
    expect_same_run("whole", "gone_on", until + " s");
  }
}

/// What a killed process leaves: no map, and a drive that ends at an arbitrary point.
TEST_F(DriveAgain, SoItIsOfARunThatWasKilled) {
  ASSERT_EQ(simulated({}, "whole").exit_code, 0);
  const std::string drive = text_of(folder("whole") / "drive.bin");
  fs::create_directories(folder("killed"));
  std::ofstream(folder("killed") / "drive.bin", std::ios::binary) << drive.substr(0, 2 * drive.size() / 3 + 5);
  const Outcome gone_on = simulated({"--map", folder("killed"), "--start", "end"}, "gone_on");
  ASSERT_EQ(gone_on.exit_code, 0) << gone_on.err;
  expect_same_run("whole", "gone_on", "cut");
}

std::string in_log(double begin_s, int scans) {
  std::string text;
  const auto line = [&](double t_s, const std::string& rest) {
    text += rest.substr(0, rest.find('@')) + std::to_string(t_s) + rest.substr(rest.find('@') + 1);
  };
  for (int k = 0; k < scans; ++k) {
    const double t_s = begin_s + k;
    line(
        t_s,
        R"({"odometry": {"t": @, "dx": 0.5, "dy": 0, "dheading": 0, "sigma_x": 0.02, "sigma_y": 0.02, "sigma_heading": 0.004}})");
    text += '\n';
    line(t_s, R"({"detections": {"t": @, "x": 5, "y": 1, "sigma_x": 0.1, "sigma_y": 0.1}})");
    text += '\n';
  }
  return text;
}

TEST_F(DriveAgain, WhatALogHoldsOfTheDriveBeforeIsPassedOver) {
  folder_.write("vehicle.toml", "[[sensor]]\nreach_m = 12\n");
  folder_.write("half.jsonl", in_log(0.0, 20));
  folder_.write("whole.jsonl", in_log(0.0, 40));
  const auto replayed = [&](const std::string& log, const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> words{"replay",  folder(log), "--vehicle", folder("vehicle.toml"),
                                   "--quiet", "--out",     folder(out)};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  ASSERT_EQ(replayed("half.jsonl", "half", {}).exit_code, 0);
  ASSERT_EQ(replayed("whole.jsonl", "whole", {}).exit_code, 0);
  const Outcome gone_on = replayed("whole.jsonl", "gone_on", {"--map", folder("half"), "--start", "end"});
  ASSERT_EQ(gone_on.exit_code, 0) << gone_on.err;
  for (const char* name : {"trajectory.tum", "map.csv", "drive.bin"}) {
    EXPECT_EQ(text_of(folder("whole") / name), text_of(folder("gone_on") / name)) << name;
  }
  EXPECT_NE(gone_on.err.find("20 scans of the run of --map are driven again first, 20 of the log are among them"),
            std::string::npos)
      << gone_on.err;
  EXPECT_NE(text_of(folder("gone_on") / "manifest.json").find("drive.bin"), std::string::npos);
  const Outcome joined = run({"join", folder("half"), folder("gone_on"), "--out", folder("joined")});
  EXPECT_EQ(joined.exit_code, 3);
  EXPECT_NE(joined.err.find("holds it already"), std::string::npos) << joined.err;
}

TEST_F(DriveAgain, ALogOfAnotherClockIsMovedBehindTheDriveBefore) {
  folder_.write("vehicle.toml", "[[sensor]]\nreach_m = 12\n");
  folder_.write("monday.jsonl", in_log(100.0, 20));
  folder_.write("tuesday.jsonl", in_log(3.0, 10));
  const std::vector<std::string> how{"--vehicle", folder("vehicle.toml"), "--quiet"};
  const auto replayed = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "replay");
    words.insert(words.end(), how.begin(), how.end());
    return run(words);
  };
  ASSERT_EQ(replayed({folder("monday.jsonl"), "--out", folder("monday")}).exit_code, 0);
  const Outcome gone_on =
      replayed({folder("tuesday.jsonl"), "--map", folder("monday"), "--start", "end", "--out", folder("tuesday")});
  ASSERT_EQ(gone_on.exit_code, 0) << gone_on.err;
  EXPECT_NE(gone_on.err.find("by another clock"), std::string::npos) << gone_on.err;
  EXPECT_EQ(complete_lines(folder("tuesday") / "health.csv"),
            complete_lines(folder("monday") / "health.csv") + complete_lines(folder("tuesday.jsonl")) / 2);
}

TEST_F(DriveAgain, ADamagedDriveEndsWithStatus3AndNamesTheFile) {
  ASSERT_EQ(simulated({"--until", "20"}, "first").exit_code, 0);
  std::string drive = text_of(folder("first") / "drive.bin");
  drive[drive.size() / 2] = static_cast<char>(drive[drive.size() / 2] ^ 1);
  std::ofstream(folder("first") / "drive.bin", std::ios::binary) << drive;
  const Outcome outcome = simulated({"--map", folder("first"), "--start", "end"}, "gone_on");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("drive.bin: byte"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(folder("gone_on") / "manifest.json"));
}

}  // namespace
}  // namespace helixnav::apps
