// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "program.hpp"
#include "small_logs.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

class BadLog : public ::testing::Test {
 protected:
  /// Writes the small release with one file replaced, as a folder.
  fs::path release_with(const std::string& file, const std::string& text) const {
    for (const auto& [name, content] : small_release()) logs_.write(name, name == file ? text : content);
    return logs_.path();
  }

  /// Replays `log` and expects an error message with these words and no output left behind.
  void expect_refused(const fs::path& log, const std::vector<std::string>& words) const {
    const fs::path out = results_.path() / "run";
    const Outcome outcome = run({"replay", log, "--out", out});
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    for (const std::string& word : words) {
      EXPECT_NE(outcome.err.find(word), std::string::npos) << "no '" << word << "' in: " << outcome.err;
    }
    EXPECT_EQ(outcome.out, "");
    EXPECT_FALSE(fs::exists(out)) << "half a run folder";
  }

  testing::TemporaryFolder logs_;
  testing::TemporaryFolder results_;
};

TEST_F(BadLog, FixtureIsRightWhenNothingIsSpoilt) {
  const Outcome outcome = run({"replay", release_with("", ""), "--out", results_.path() / "run"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(results_.path() / "run" / "summary.json"));
}

TEST_F(BadLog, ThatIsNotThereIsNamed) { expect_refused(logs_.path() / "nowhere.zip", {"nowhere.zip", "expected"}); }

TEST_F(BadLog, OfWhichOneFileIsMissingIsNamed) {
  fs::remove(release_with("", "") / "GPS.txt");
  expect_refused(logs_.path(), {"GPS.txt", "expected"});
}

TEST_F(BadLog, CutOffInAnyPartOfAZipIsRefused) {
  const std::string whole = text_of(write_zip(logs_.path() / "whole.zip", small_release()));
  for (const std::size_t eighths : {1u, 3u, 5u, 7u}) {
    const fs::path cut = logs_.write("cut.zip", whole.substr(0, whole.size() * eighths / 8));
    SCOPED_TRACE(eighths);
    expect_refused(cut, {"cut.zip", "expected"});
  }
}

TEST_F(BadLog, OfGarbageIsToldWhatWasLookedFor) {
  std::string garbage;
  for (unsigned i = 0; i < 4096; ++i) garbage += static_cast<char>(i * 2654435761u >> 13);
  expect_refused(logs_.write("garbage.bin", garbage), {"garbage.bin", "no known log", "ACFR", "iSAM"});
}

TEST_F(BadLog, WithGarbageAfterGoodLinesIsNamedByLine) {
  expect_refused(release_with("DRS.txt", "0.1\t1.0\t0.05\n\x01\x02garb\xff\xfe\x7f\n"), {"DRS.txt:2", "expected"});
}

TEST_F(BadLog, ThatIsEmptyIsRefused) {
  expect_refused(logs_.write("empty.txt", ""), {"empty.txt", "no known log"});
  expect_refused(release_with("DRS.txt", ""), {"Sensors_manager.txt:2", "expected row 1 of sensor 2"});
  expect_refused(release_with("LASER.txt", ""), {"Sensors_manager.txt:3", "expected row 1 of sensor 3"});
  for (const auto& [name, content] : small_release()) logs_.write(name, "");
  expect_refused(logs_.path(), {"DRS.txt", "expected at least one"});
}

TEST_F(BadLog, InAnEmptyFolderIsRefused) { expect_refused(logs_.path(), {"no known log", "DRS.txt"}); }

TEST_F(BadLog, WithNaNIsNamedByLine) {
  expect_refused(release_with("DRS.txt", "0.1\t1.0\t0.05\n0.2\tnan\t0.06\n"), {"DRS.txt:2", "expected", "nan"});
  expect_refused(release_with("GPS.txt", "0.0\t3.0\tinf\n"), {"GPS.txt:1", "expected", "inf"});
}

TEST_F(BadLog, WithTimeGoingBackwardsIsNamedByLine) {
  expect_refused(release_with("DRS.txt", "0.2\t1.0\t0.05\n0.1\t1.5\t0.06\n"), {"DRS.txt:2", "time"});
}

TEST_F(BadLog, WithAWrongNumberOfColumnsIsNamedByLine) {
  expect_refused(release_with("DRS.txt", "0.1\t1.0\t0.05\n0.2\t1.5\n"), {"DRS.txt:2", "expected a steering angle"});
  expect_refused(release_with("GPS.txt", "0.0\t3.0\t4.0\t5.0\n"),
                 {"GPS.txt:1", "more columns than time, northing, easting"});
}

TEST_F(BadLog, WhoseScanStopsHalfwayIsNamedByByte) {
  expect_refused(release_with("LASER.txt", "0.15\t2.50\t2.50\t2.50"), {"LASER.txt", "byte 19", "expected"});
}

TEST_F(BadLog, OfALandmarkGraphIsNamedByLine) {
  const std::string good = circle_graph(3);
  expect_refused(logs_.write("short.txt", good + "ODOMETRY 4 5 0.2\n"), {"short.txt:8", "expected"});
  expect_refused(logs_.write("nan.txt", good + "LANDMARK 4 1 nan 20 5 0 5\n"), {"nan.txt:8", "expected", "nan"});
  expect_refused(logs_.write("word.txt", good + "LANDMRK 4 1 0 20 5 0 5\n"), {"word.txt:8", "LANDMRK"});
}

TEST_F(BadLog, CutInAMatlabFileIsRefused) {
  expect_refused(logs_.write("cut.mat", std::string("MATLAB 5.0 MAT-file, cut").append(104, ' ')), {"cut.mat"});
}

TEST_F(BadLog, LeavesAnEarlierRunInTheSameFolderAlone) {
  const fs::path out = results_.path() / "run";
  ASSERT_EQ(run({"replay", release_with("", ""), "--out", out}).exit_code, 0);
  const std::string before = text_of(out / "health.csv");
  release_with("DRS.txt", "0.1\tnan\t0.05\n");
  EXPECT_EQ(run({"replay", logs_.path(), "--out", out, "--overwrite"}).exit_code, 3);
  EXPECT_EQ(text_of(out / "health.csv"), before);
}

TEST_F(BadLog, WithoutLabelsIsRefusedForKnownAssociation) {
  const fs::path out = results_.path() / "run";
  const Outcome outcome = run({"replay", release_with("", ""), "--out", out, "--association", "known"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("no labels"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(out));
}

TEST(BadRunFolder, IsRefusedByEvaluate) {
  const testing::TemporaryFolder folder;
  for (const fs::path& path : {folder.path() / "nowhere", folder.path()}) {
    const Outcome outcome = run({"evaluate", path});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_NE(outcome.err.find("manifest.json"), std::string::npos) << outcome.err;
  }
}

}  // namespace
}  // namespace helixnav::apps
