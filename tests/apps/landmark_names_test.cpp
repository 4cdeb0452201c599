// SPDX-License-Identifier: BSD-3-Clause
#include "drive/landmark_names.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/runs/run_folder.hpp"
#include "program.hpp"

namespace helixnav::apps {
namespace {

/// Four poles beside a straight road, named by words or by numbers. The first may be moved before the sixth scan.
void write_named_log(const testing::TemporaryFolder& folder, const std::vector<std::string>& names, bool is_moved) {
  std::string odometry = "t,v,omega\n", detections = "t,x_m,y_m,id\n";
  for (int t = 0; t <= 10; ++t) {
    odometry += std::to_string(t) + ",1,0\n";
    for (std::size_t pole = 0; pole < names.size(); ++pole) {
      const double y_m = is_moved && pole == 0 && t > 4 ? 12.0 : 4.0;
      detections += std::to_string(t) + ',' + std::to_string(6.0 + 3.0 * static_cast<double>(pole) - t) + ',' +
                    std::to_string(y_m) + ',' + names[pole] + '\n';
    }
  }
  folder.write("log/vehicle.toml",
               "[odometry]\nsigma_v_mps = 0.05\nsigma_omega_deg_per_s = 0.3\n[[sensor]]\nreach_m = 30\n"
               "sigma_point_m = 0.1\n");
  folder.write("log/odometry.csv", odometry);
  folder.write("log/detections.csv", detections);
}

std::map<core::LandmarkId, std::string> names_in_run(const std::vector<std::string>& names, bool is_known,
                                                     bool is_moved = false) {
  const testing::TemporaryFolder folder;
  write_named_log(folder, names, is_moved);
  const std::filesystem::path out = folder.path() / "run";
  std::vector<std::string> words{"replay", folder.path() / "log", "--out", out, "--quiet"};
  if (is_known) words.insert(words.end(), {"--association", "known"});
  const Outcome outcome = run(words);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const runs::Run read = runs::read_run(out);
  EXPECT_EQ(read.map.size(), names.size());
  return read.names;
}

TEST(LandmarkNames, StandInTheMapAsTheLogHasThem) {
  using Names = std::map<core::LandmarkId, std::string>;
  EXPECT_EQ(names_in_run({"oak", "elm", "beech", "gate 4"}, true),
            (Names{{0, "oak"}, {1, "elm"}, {2, "beech"}, {3, "gate 4"}}));
  EXPECT_EQ(names_in_run({"11", "400", "7", "12"}, true), (Names{{0, "11"}, {1, "400"}, {2, "7"}, {3, "12"}}));
  EXPECT_EQ(names_in_run({"oak", "elm", "beech", "gate 4"}, false), Names());
}

/// Seen twice where it is now, and five times where it was.
TEST(LandmarkNames, AreOfTheLandmarksThatAreStillInTheMap) {
  EXPECT_EQ(names_in_run({"oak", "elm", "beech", "gate 4"}, true, true),
            (std::map<core::LandmarkId, std::string>{{1, "elm"}, {2, "beech"}, {3, "gate 4"}, {4, "oak"}}));
}

/// Its numbers for the words of its log would be taken for this log's.
TEST(LandmarkNames, AreNotGuessedForAMapWithoutThem) {
  const testing::TemporaryFolder folder;
  write_named_log(folder, {"oak", "elm", "beech", "gate 4"}, false);
  const std::string log = folder.path() / "log", map = folder.path() / "run";
  ASSERT_EQ(run({"replay", log, "--out", map, "--quiet"}).exit_code, 0);
  using Words = std::vector<std::string>;
  for (const Words& how : {Words{"--start", "0,0,0"}, Words{"--localize"}}) {
    Words words{"replay", log, "--map", map, "--association", "known", "--out", folder.path() / "b", "--quiet"};
    words.insert(words.end(), how.begin(), how.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 3) << how.front();
    EXPECT_NE(outcome.err.find("needs to know the names of the map's landmarks"), std::string::npos) << outcome.err;
  }
}

TEST(LandmarkNames, AreTheSameOnAnotherDayInAnotherOrder) {
  core::Recording tuesday;
  tuesday.label_names = {"elm", "birch", "oak"};
  std::map<core::Label, core::LandmarkId> landmark_of{{0, 10}, {1, 11}, {2, 12}};
  const std::map<core::LandmarkId, std::string> monday{{10, "oak"}, {11, "elm"}, {12, "beech"}};
  number_by_names(monday, tuesday, landmark_of);
  EXPECT_EQ(landmark_of, (std::map<core::Label, core::LandmarkId>{{2, 10}, {0, 11}, {3, 12}}));
  EXPECT_EQ(tuesday.label_names, (std::vector<std::string>{"elm", "birch", "oak", "beech"}));
  EXPECT_EQ(landmarks_by_name({{10, "7"}, {11, "elm"}}, {}), (std::map<core::Label, core::LandmarkId>{{7, 10}}))
      << "of a log whose names are numbers";
  core::Recording numbered;
  number_by_names(monday, numbered, landmark_of);
  EXPECT_EQ(landmark_of.at(2), 10) << "numbers are the same every day";
}

}  // namespace
}  // namespace helixnav::apps
