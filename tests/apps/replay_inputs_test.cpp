// SPDX-License-Identifier: BSD-3-Clause
// What replay reads besides files and folders, and what it says about settings and logs that are now read differently.
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "program.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

/// t, x, y of the last line.
std::vector<double> last_pose(const fs::path& trajectory) {
  std::ifstream lines(trajectory);
  std::string line, last;
  while (std::getline(lines, line)) last = line;
  std::istringstream words(last);
  std::vector<double> numbers(3);
  for (double& number : numbers) words >> number;
  return numbers;
}

class ReplayInputs : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(run({"new-vehicle", log_}).exit_code, 0); }

  void expect_same_run(const fs::path& one, const fs::path& other) const {
    for (const char* name : {"trajectory.tum", "map.csv", "associations.csv", "decisions.csv"}) {
      EXPECT_EQ(text_of(one / name), text_of(other / name)) << name;
    }
  }

  testing::TemporaryFolder folder_;
  const fs::path log_ = folder_.path() / "robot";
};

TEST_F(ReplayInputs, JsonLinesThroughAFifoGiveTheRunThatTheyGiveAsAFile) {
  const fs::path lines = log_ / "drive.jsonl";
  ASSERT_EQ(run({"convert", log_, lines}).exit_code, 0);
  ASSERT_EQ(run({"replay", lines, "--out", folder_.path() / "of_file", "--quiet"}).exit_code, 0);
  const fs::path fifo = log_ / "pipe";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(fifo, std::ios::binary) << std::ifstream(lines, std::ios::binary).rdbuf(); });
  const Outcome outcome = run({"replay", fifo, "--out", folder_.path() / "of_fifo", "--quiet"});
  writer.join();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  expect_same_run(folder_.path() / "of_file", folder_.path() / "of_fifo");
}

TEST_F(ReplayInputs, ConvertedToJsonLinesALogLeadsToTheSamePose) {
  const fs::path apart = folder_.path() / "apart";
  fs::create_directories(apart);
  ASSERT_EQ(run({"convert", log_, apart / "drive.jsonl"}).exit_code, 0);
  ASSERT_TRUE(fs::exists(apart / "vehicle.toml"));
  const std::vector<std::string> as_the_example = {"--association.detection_probability",
                                                   "0.9",
                                                   "--landmarks.detection_probability",
                                                   "0.9",
                                                   "--association.extraneous_per_scan",
                                                   "1.0",
                                                   "--quiet"};
  const auto navigate = [&](const fs::path& log, const char* name) {
    std::vector<std::string> words{"replay", log, "--out", folder_.path() / name};
    words.insert(words.end(), as_the_example.begin(), as_the_example.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return last_pose(folder_.path() / name / "trajectory.tum");
  };
  const std::vector<double> one = navigate(log_, "one"), other = navigate(apart / "drive.jsonl", "other");
  ASSERT_EQ(one.size(), 3u);
  ASSERT_EQ(other.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(one[k], other[k], 1e-6);  // sigmas are written, not variances
}

TEST_F(ReplayInputs, ARawlogIsRefusedWithTheProgramThatReadsIt) {
  const fs::path rawlog = folder_.write("drive.rawlog", "\x1f\x8b no matter");
  const Outcome outcome = run({"replay", rawlog, "--out", folder_.path() / "run"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("helixnav-rawlog drive.rawlog drive.jsonl"), std::string::npos) << outcome.err;
}

TEST_F(ReplayInputs, DeprecatedSettingsAreNamedOnceWithTheKeysThatReplaceThem) {
  const Outcome outcome = run({"check", log_, "--victoria_park.speed_scale", "1.01", "--plaza.range_scale", "1.02"});
  const std::string& said = outcome.err;
  EXPECT_NE(said.find("victoria_park.speed_scale is now odometry.scale"), std::string::npos) << said;
  EXPECT_NE(said.find("plaza.range_scale is now sensor.range_scale"), std::string::npos) << said;
  EXPECT_EQ(said.find("deprecated"), said.rfind("deprecated")) << said;
  EXPECT_EQ(run({"check", log_}).err.find("deprecated"), std::string::npos);
}

/// The example log with additional columns in detections.csv.
void write_with_columns(const fs::path& from, const fs::path& to, const std::string& names, const std::string& cells) {
  fs::create_directories(to);
  for (const char* file : {"odometry.csv", "vehicle.toml"}) fs::copy_file(from / file, to / file);
  std::ifstream in(from / "detections.csv");
  std::ofstream out(to / "detections.csv");
  std::string row;
  bool header = true;
  while (std::getline(in, row)) {
    out << row << (header ? names : cells) << '\n';
    header = false;
  }
}

TEST_F(ReplayInputs, ClassesAndSizesThatAreNotGivenChangeNothing) {
  const fs::path bare = folder_.path() / "bare", empty = folder_.path() / "empty", told = folder_.path() / "told";
  write_with_columns(log_, bare, "", "");
  write_with_columns(log_, empty, ",class,size_m,sigma_size_m", ",,,");
  write_with_columns(log_, told, ",class,size_m,sigma_size_m", ",oak,0.4,0.05");
  for (const fs::path& log : {bare, empty, told}) {
    ASSERT_EQ(run({"replay", log, "--out", fs::path(log) += "_run", "--quiet"}).exit_code, 0);
  }
  expect_same_run(fs::path(bare) += "_run", fs::path(empty) += "_run");
  const std::string map = text_of((fs::path(told) += "_run") / "map.csv");
  EXPECT_NE(map.find("state,class,class_nats,size,sigma_size\n"), std::string::npos);
  EXPECT_NE(map.find(",oak,"), std::string::npos);
}

TEST_F(ReplayInputs, AnEarlierMapBringsItsClassesAlong) {
  const fs::path told = folder_.path() / "told", first = folder_.path() / "first", second = folder_.path() / "second";
  write_with_columns(log_, told, ",class,size_m,sigma_size_m", ",oak,0.4,0.05");
  ASSERT_EQ(run({"replay", told, "--out", first, "--quiet"}).exit_code, 0);
  ASSERT_EQ(run({"replay", log_, "--map", first, "--start", "0,0,0", "--out", second, "--quiet"}).exit_code, 0);
  EXPECT_NE(text_of(second / "map.csv").find(",oak,"), std::string::npos);
}

TEST_F(ReplayInputs, WhatCannotBeAClassOrASizeIsRefusedWithItsPlace) {
  const fs::path named = folder_.path() / "named", sized = folder_.path() / "sized";
  write_with_columns(log_, named, ",class", ",a name of more than 23 bytes");
  const Outcome by_name = run({"check", named});
  EXPECT_EQ(by_name.exit_code, 3);
  EXPECT_NE(by_name.err.find("detections.csv:2:"), std::string::npos) << by_name.err;
  write_with_columns(log_, sized, ",size_m", ",0.4");
  const Outcome by_size = run({"check", sized});
  EXPECT_EQ(by_size.exit_code, 3);
  EXPECT_NE(by_size.err.find("sigma_size_m"), std::string::npos) << by_size.err;
}

}  // namespace
}  // namespace helixnav::apps
