// SPDX-License-Identifier: BSD-3-Clause
// Run folders, maps and settings that have been altered, or are endless.
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "program.hpp"
#include "sanitized.hpp"
#include "small_logs.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

class HostileRun : public ::testing::Test {
 protected:
  void SetUp() override {
    log_ = folder_.write("circle.isam", circle_graph(60));
    ASSERT_EQ(drive(run_).exit_code, 0);
  }
  Outcome drive(const fs::path& out) const {
    return run({"replay", log_, "--association", "known", "--quiet", "--out", out});
  }
  Outcome localise(const fs::path& map, const std::function<void()>& prepare = {}) const {
    return run({"replay", log_, "--localize", "--map", map, "--quiet", "--overwrite", "--out", in("located")}, prepare);
  }
  fs::path in(const std::string& name) const { return folder_.path() / name; }
  void put_folder_in_place_of(const fs::path& file) const {
    fs::remove(file);
    fs::create_directory(file);
  }
  static void expect_refused(const Outcome& outcome, const std::string& words) {
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  }

  testing::TemporaryFolder folder_;
  fs::path log_;
  const fs::path run_ = folder_.path() / "run";
};

TEST_F(HostileRun, WithAFolderInPlaceOfAFileIsRefusedByWhoeverReadsIt) {
  ASSERT_EQ(drive(in("other")).exit_code, 0);
  put_folder_in_place_of(run_ / "map.bin");
  expect_refused(run({"join", run_, in("other"), "--out", in("joined")}), "map.bin: expected a file, found a folder");
  put_folder_in_place_of(run_ / "map.csv");
  expect_refused(localise(run_), "map.csv: expected a file, found a folder");
  put_folder_in_place_of(run_ / "health.csv");
  for (const char* command : {"evaluate", "explain"}) {
    expect_refused(run({command, run_}), "health.csv: expected a file, found a folder");
  }
  put_folder_in_place_of(run_ / "manifest.json");
  expect_refused(run({"evaluate", run_}), "manifest.json: expected a file, found a folder");
}

TEST_F(HostileRun, WithAFolderInPlaceOfTheDriveIsRefusedByWhatGoesOnThere) {
  ASSERT_EQ(run({"new-vehicle", in("robot")}).exit_code, 0);
  ASSERT_EQ(run({"replay", in("robot"), "--quiet", "--out", in("first")}).exit_code, 0);
  put_folder_in_place_of(in("first") / "drive.bin");
  expect_refused(run({"replay", in("robot"), "--map", in("first"), "--start", "end", "--out", in("second")}),
                 "drive.bin: expected a file, found a folder");
}

/// The header and the first rows of a table.
void cut_table(const fs::path& file, int rows) {
  std::istringstream whole(text_of(file));
  std::string kept, line;
  for (int k = 0; k <= rows && std::getline(whole, line); ++k) kept += line + '\n';
  std::ofstream(file, std::ios::binary) << kept;
}

TEST_F(HostileRun, WhoseTablesWereCutIsJudgedWithAWarning) {
  EXPECT_EQ(run({"evaluate", run_}).err, "");
  EXPECT_EQ(localise(run_).err.find("rows"), std::string::npos);
  cut_table(run_ / "associations.csv", 20);
  for (const char* command : {"evaluate", "explain"}) {
    const Outcome outcome = run({command, run_});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("warning: " + (run_ / "associations.csv").string() + ": 20 of 61 rows"),
              std::string::npos)
        << outcome.err;
  }
  EXPECT_NE(localise(run_).err.find("associations.csv: 20 of 61 rows"), std::string::npos);
}

TEST(HostileMapOfAJoin, ThatWasCutIsUsedWithAWarning) {
  const testing::TemporaryFolder folder;
  const fs::path log = folder.path() / "robot", first = folder.path() / "run", map = folder.path() / "map";
  ASSERT_EQ(run({"new-vehicle", log}).exit_code, 0);
  ASSERT_EQ(run({"replay", log, "--quiet", "--out", first}).exit_code, 0);
  fs::create_directory(map);
  for (const char* name : {"map.csv", "map.bin"}) fs::copy_file(first / name, map / name);
  const auto localise = [&](const fs::path& in) {
    return run({"replay", log, "--localize", "--map", in, "--quiet", "--overwrite", "--out", folder.path() / "out"});
  };
  const std::size_t landmarks = complete_lines(map / "map.csv") - 1;
  EXPECT_EQ(localise(map).err.find("map.csv"), std::string::npos);
  cut_table(map / "map.csv", static_cast<int>(landmarks / 2));
  const std::string numbers = std::to_string(landmarks / 2) + " of the " + std::to_string(landmarks) + " landmarks";
  for (const fs::path& given : {map, map / "map.csv"}) {
    const Outcome outcome = localise(given);
    EXPECT_NE(outcome.err.find("map.csv: " + numbers + " that map.bin beside it has"), std::string::npos)
        << outcome.err;
  }
  cut_table(first / "map.csv", static_cast<int>(landmarks / 2));
  const Outcome outcome = localise(first);
  EXPECT_NE(
      outcome.err.find("map.csv: " + std::to_string(landmarks / 2) + " of " + std::to_string(landmarks) + " rows"),
      std::string::npos)
      << outcome.err;
}

/// 1.5 gigabytes.
void allow_little_memory() {
  const rlimit little{3u << 29, 3u << 29};
  if (::setrlimit(RLIMIT_AS, &little) != 0) ::_exit(125);
}

TEST_F(HostileRun, FilesWithoutEndAreRefusedBeforeTheyFillTheMemory) {
  if (support::sanitized) return;  // they take more address space than is allowed here
  expect_refused(localise("/dev/zero", allow_little_memory), "/dev/zero: expected a file of at most 67108864 bytes");
  const std::vector<std::vector<std::string>> commands{{"config", "--check", "/dev/zero"},
                                                       {"replay", log_, "--config", "/dev/zero", "--out", in("none")}};
  for (const std::vector<std::string>& command : commands) {
    const Outcome outcome = run(command, allow_little_memory);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find("/dev/zero: expected a file of at most 1048576 bytes, found more"), std::string::npos)
        << outcome.err;
  }
}

TEST(HostileVehicle, WithoutEndIsRefusedBeforeItIsDigested) {
  const Outcome outcome = run({"stream", "--vehicle", "/dev/zero"}, [] { ::alarm(20); });
  EXPECT_EQ(outcome.exit_code, 3) << "ended by signal " << outcome.signal;
  EXPECT_NE(outcome.err.find("/dev/zero: expected a file, found a device"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace helixnav::apps
