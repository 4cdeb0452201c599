// SPDX-License-Identifier: BSD-3-Clause
// No command overwrites its own input, even with --overwrite.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "program.hpp"
#include "small_logs.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

class KeptInputs : public ::testing::Test {
 protected:
  fs::path in(const std::string& name) const { return folder_.path() / name; }
  void must(const std::vector<std::string>& words) const {
    const Outcome outcome = run(words);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  /// Expects a refusal with this reason, and all files of the folder unchanged.
  void expect_refused(const std::vector<std::string>& words, const fs::path& kept) const {
    const std::map<std::string, std::string> before = texts_in(kept);
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_NE(outcome.err.find("would be lost by writing there"), std::string::npos) << outcome.err;
    EXPECT_TRUE(before == texts_in(kept)) << kept << " is not as it was";
  }
  /// Two runs of a circle and their log.
  void drive_circle() const {
    folder_.write("circle.isam", circle_graph(60));
    for (const char* name : {"run", "other"}) {
      must({"replay", in("circle.isam"), "--association", "known", "--quiet", "--out", in(name)});
    }
  }

  testing::TemporaryFolder folder_;

 private:
  static std::map<std::string, std::string> texts_in(const fs::path& folder) {
    std::map<std::string, std::string> texts;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) texts[entry.path().string()] = text_of(entry.path());
    }
    return texts;
  }
};

TEST_F(KeptInputs, AReplayIntoTheFolderOfItsLogIsRefused) {
  must({"new-vehicle", in("robot")});
  ASSERT_TRUE(fs::exists(in("robot") / "truth_poses.csv"));
  expect_refused({"replay", in("robot"), "--out", in("robot"), "--overwrite"}, in("robot"));
  fs::create_directory_symlink(in("robot"), in("link"));
  expect_refused({"replay", in("robot"), "--out", in("link"), "--overwrite"}, in("robot"));
}

TEST_F(KeptInputs, ALogWhoseFileLiesElsewhereIsFollowedThere) {
  must({"new-vehicle", in("robot")});
  fs::create_directory(in("out"));
  fs::rename(in("robot") / "truth_poses.csv", in("out") / "truth_poses.csv");
  fs::create_symlink(in("out") / "truth_poses.csv", in("robot") / "truth_poses.csv");
  expect_refused({"replay", in("robot"), "--out", in("out"), "--overwrite"}, in("out"));
}

TEST_F(KeptInputs, AMapIsNotReplacedByTheRunThatLocalisesInIt) {
  drive_circle();
  const std::string log = in("circle.isam");
  const std::vector<std::string> beginning{"replay", log, "--localize", "--out", in("run"), "--overwrite", "--map"};
  for (const fs::path& map : {in("run"), in("run") / "map.csv"}) {
    std::vector<std::string> words = beginning;
    words.push_back(map);
    expect_refused(words, in("run"));
  }
  must({"replay", log, "--localize", "--map", in("run") / "map.csv", "--quiet", "--out", in("other"), "--overwrite"});
}

TEST_F(KeptInputs, ASmoothingDoesNotReplaceTheRunThatItStartsFrom) {
  drive_circle();
  expect_refused({"smooth", in("circle.isam"), "--start", in("run"), "--out", in("run"), "--overwrite"}, in("run"));
}

TEST_F(KeptInputs, ALogThatIsCalledAsAFileOfARunIsNotReplaced) {
  folder_.write("out/map.csv", circle_graph(30));
  expect_refused({"smooth", in("out") / "map.csv", "--out", in("out"), "--overwrite"}, in("out"));
  folder_.write("out/circle.isam", circle_graph(30));  // stays as it is
  must({"smooth", in("out") / "circle.isam", "--out", in("out"), "--overwrite"});
}

TEST_F(KeptInputs, APartOfARunIsNotReplacedByTheRunThatGoesOnInIt) {
  drive_circle();
  fs::create_directory(in("run") / "part_1");
  fs::copy_file(in("other") / "map.bin", in("run") / "part_1" / "map.bin");
  expect_refused({"simulate", "circuit", "--map", in("run") / "part_1", "--out", in("run"), "--overwrite"}, in("run"));
}

TEST_F(KeptInputs, AJoinDoesNotReplaceItsComponents) {
  drive_circle();
  fs::create_directories(in("joined") / "component_2");
  fs::copy_file(in("run") / "map.bin", in("joined") / "component_2" / "map.bin");
  expect_refused({"join", in("joined") / "component_2", in("other"), "--out", in("joined"), "--overwrite"},
                 in("joined"));
}

TEST_F(KeptInputs, AConversionReplacesNeitherItsLogNorATableOfIt) {
  must({"new-vehicle", in("robot")});
  expect_refused({"convert", in("robot"), in("robot") / "odometry.csv", "--to", "jsonl", "--overwrite"}, in("robot"));
  for (int time = 0; time < 2; ++time) {  // its own output may be overwritten
    must({"convert", in("robot"), in("robot") / "drive.jsonl", "--overwrite"});
  }
  folder_.write("graphs/circle.isam", circle_graph(30));
  const std::string graph = in("graphs") / "circle.isam";
  expect_refused({"convert", graph, graph, "--overwrite"}, in("graphs"));
}

TEST_F(KeptInputs, ACalibrationReplacesNoFile) {
  must({"new-vehicle", in("robot")});
  const std::string vehicle = in("robot") / "vehicle.toml";
  const std::string before = text_of(vehicle);
  EXPECT_EQ(run({"calibrate", in("robot"), "--out", vehicle}).exit_code, 3);
  EXPECT_EQ(text_of(vehicle), before);
}

}  // namespace
}  // namespace helixnav::apps
