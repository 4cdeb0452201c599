// SPDX-License-Identifier: BSD-3-Clause
// Files of a completed run that were truncated afterwards.
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/files/file.hpp"
#include "helixnav/runs/drive_file.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "run_example.hpp"
#include "temporary_folder.hpp"

namespace helixnav::runs {
namespace {

namespace fs = std::filesystem;
using helixnav::testing::TemporaryFolder;

/// The first lines of a file.
void keep_lines(const std::string& file, int lines) {
  std::istringstream whole(files::read_whole_file(file));
  std::string kept, line;
  for (int k = 0; k < lines && std::getline(whole, line); ++k) kept += line + '\n';
  std::ofstream(file, std::ios::binary) << kept;
}

TEST(CutRunFolder, ThatCameToItsEndTellsWhichTableWasCutSince) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  write_example(path, 100);
  EXPECT_EQ(read_run(path).missing, std::vector<std::string>{});
  const std::string end = " rows: the run came to its end, and the file was cut since";
  using Cut = std::pair<const char*, std::string>;
  for (const auto& [table, rows] :
       {Cut{"health.csv", "40 of 100"}, Cut{"trajectory.tum", "40 of 100"}, Cut{"associations.csv", "40 of 342"}}) {
    const std::string file = path + '/' + table, whole = files::read_whole_file(file);
    keep_lines(file, 41);
    EXPECT_EQ(read_run(path).missing, std::vector<std::string>{file + ": " + rows + end}) << table;
    std::ofstream(file, std::ios::binary) << whole;
  }
  keep_lines(path + "/map.csv", 2);
  EXPECT_EQ(read_run(path).missing, std::vector<std::string>{path + "/map.csv: 1 of 3" + end});
  fs::remove(path + "/summary.json");  // like a run that was killed
  EXPECT_EQ(read_run(path).missing, std::vector<std::string>{});
}

TEST(CutRunFolder, ThatCameToItsEndTellsWhichTruthWasCutSince) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string();
  write_example(path, 100);
  int cut = 0;
  for (const char* table : {"truth_poses.csv", "truth_positions.csv", "truth_landmarks.csv", "truth_labels.csv"}) {
    const std::string file = path + '/' + table;
    if (!fs::exists(file)) continue;
    ++cut;
    const std::string whole = files::read_whole_file(file);
    keep_lines(file, 2);
    const std::vector<std::string> missing = read_run(path).missing;
    ASSERT_EQ(missing.size(), 1U) << table;
    EXPECT_EQ(missing[0].rfind(file + ": 1 of ", 0), 0U) << missing[0];
    std::ofstream(file, std::ios::binary) << whole;
  }
  EXPECT_GE(cut, 2);
}

TEST(CutRunFolder, ThatCameToItsEndTellsWhetherItsDriveWasCutSince) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "run").string(), file = path + "/drive.bin";
  write_example(path, 3);
  {
    DriveFile drive(file, core::PoseGaussian());
    for (core::Nanoseconds t_ns = 1; t_ns <= 3; ++t_ns) {
      core::Scan scan;
      scan.t_ns = t_ns;
      drive.add(scan);
    }
    drive.finish();
  }
  EXPECT_EQ(read_run(path).missing, std::vector<std::string>{});
  const std::string whole = files::read_whole_file(file);
  for (std::size_t bytes = whole.size(); bytes-- > 0;) {
    fs::resize_file(file, bytes);
    const std::vector<std::string> missing = read_run(path).missing;
    ASSERT_EQ(missing.size(), 1U) << bytes;
    EXPECT_NE(missing[0].find("of 3 scans: the run came to its end, and the file was cut since"), std::string::npos);
  }
  fs::remove(path + "/summary.json");  // like a run that was killed
  EXPECT_EQ(read_run(path).missing, std::vector<std::string>{});
}

}  // namespace
}  // namespace helixnav::runs
