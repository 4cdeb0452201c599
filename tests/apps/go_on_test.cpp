// SPDX-License-Identifier: BSD-3-Clause
// replay --map: a session continues in the map of an earlier one.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/core/se2.hpp"
#include "program.hpp"
#include "temporary_folder.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double radius_m = 20.0;
constexpr double reach_m = 15.0;

std::vector<Eigen::Vector2d> grove(std::uint64_t world, int trees) {
  core::RandomStream random(world, "grove");
  std::vector<Eigen::Vector2d> points_m;
  while (static_cast<int>(points_m.size()) < trees) {
    const double x_m = random.uniform(-32.0, 32.0);
    points_m.emplace_back(x_m, random.uniform(-32.0, 32.0));
  }
  return points_m;
}

/// A drive round a circle through the grove, starting at `begin_rad`, as a labelled DLR text.
std::string drive_text(const std::vector<Eigen::Vector2d>& trees_m, double begin_rad, int steps, std::uint64_t day) {
  core::RandomStream random(day, "drive");
  std::string text;
  char line[200];
  const auto pose_at = [&](int k) {
    const double angle_rad = begin_rad + k * 0.5 / radius_m;
    return core::Pose2(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), angle_rad + 0.5 * core::pi);
  };
  for (int k = 0; k < steps; ++k) {
    const core::Pose2 step = k == 0 ? core::Pose2() : core::between(pose_at(k - 1), pose_at(k));
    const double along_m = random.normal(0.0, 0.01);
    const double turn_rad = random.normal(0.0, 0.002);
    std::snprintf(line, sizeof line, "STEP img%d %.9f %.9f %.9f 1e-4 0 1e-4 0 0 4e-6\n", 1000 + k, step.x_m + along_m,
                  step.y_m, step.heading_rad + turn_rad);
    text += line;
    for (std::size_t i = 0; i < trees_m.size(); ++i) {
      const Eigen::Vector2d seen_m = core::transform(core::inverse(pose_at(k)), trees_m[i]);
      if (seen_m.norm() > reach_m) continue;
      const double dx_m = random.normal(0.0, 0.05);
      const double dy_m = random.normal(0.0, 0.05);
      std::snprintf(line, sizeof line, "LANDMARK_C %.6f %.6f 1 0.0025 0 0.0025 %zu\n", seen_m.x() + dx_m,
                    seen_m.y() + dy_m, i);
      text += line;
    }
  }
  return text;
}

class GoOn : public ::testing::Test {
 protected:
  fs::path folder(const std::string& name) const { return folder_.path() / name; }
  json summary(const std::string& name) const { return json::parse(text_of(folder(name) / "summary.json")); }
  Outcome replay(const std::string& log, const std::vector<std::string>& words, const std::string& out) const {
    std::vector<std::string> all{"replay",  folder(log), "--log.max_range_m", "15", "--log.view_deg", "360",
                                 "--quiet", "--out",     folder(out)};
    all.insert(all.end(), words.begin(), words.end());
    return run(all);
  }
  void must(const std::string& log, const std::vector<std::string>& words, const std::string& out) const {
    const Outcome outcome = replay(log, words, out);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder(name), std::ios::binary) << text;
  }
  void write_yesterday() const {
    write("monday.circles", drive_text(grove(1, 50), 0.0, 300, 1));
    must("monday.circles", {}, "monday");
  }

  testing::TemporaryFolder folder_;
};

TEST_F(GoOn, ASessionBegunAnywhereIsPlacedAndBecomesOneMap) {
  write_yesterday();
  ASSERT_TRUE(fs::exists(folder("monday") / "map.bin"));
  write("tuesday.circles", drive_text(grove(1, 50), 2.0, 240, 2));
  must("tuesday.circles", {"--map", folder("monday")}, "tuesday");
  const json found = summary("tuesday");
  EXPECT_EQ(found.at("placed").at("found"), true);
  EXPECT_LT(found.at("placed").at("driven_m"), 60.0);
  EXPECT_NEAR(found.at("landmarks").at("mature").get<double>(), summary("monday").at("landmarks").at("mature"), 3);
  EXPECT_TRUE(fs::exists(folder("tuesday") / "trajectory_final.tum"));
  const std::string told = run({"explain", folder("tuesday")}).out;
  EXPECT_NE(told.find("Found its place on the earlier map"), std::string::npos) << told;
  EXPECT_NE(text_of(folder("tuesday") / "manifest.json").find("map.bin"), std::string::npos);
  // In Monday's frame from the first step on: 2 rad further round the circle that started at its origin.
  std::ifstream final_poses(folder("tuesday") / "trajectory_final.tum");
  std::string header;
  std::getline(final_poses, header);
  double t_s = 0.0, x_m = 0.0, y_m = 0.0;
  final_poses >> t_s >> x_m >> y_m;
  // DLR's x axis points to the left of ours.
  EXPECT_NEAR(y_m, radius_m * std::sin(2.0), 0.5);
  EXPECT_NEAR(-x_m, radius_m * (1.0 - std::cos(2.0)), 0.5);
  // And a third session continues in the result of both.
  const Outcome again = replay("monday.circles", {"--map", folder("tuesday")}, "wednesday");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.err.find("holds this drive already"), std::string::npos) << again.err;
  EXPECT_EQ(summary("wednesday").at("placed").at("found"), true);
}

TEST_F(GoOn, AnotherPlaceIsNotHereAndSaidSo) {
  write_yesterday();
  write("elsewhere.circles", drive_text(grove(2, 50), 0.0, 200, 3));
  const std::string never = "the vehicle never found its place on the earlier map";
  const Outcome mapped = replay("elsewhere.circles", {"--map", folder("monday")}, "elsewhere");
  ASSERT_EQ(mapped.exit_code, 0) << mapped.err;
  EXPECT_NE(mapped.err.find(never), std::string::npos) << mapped.err;
  EXPECT_NE(mapped.err.find("closest to an answer was question"), std::string::npos) << mapped.err;
  EXPECT_EQ(mapped.err.find("holds this drive"), std::string::npos) << mapped.err;
  const Outcome localised =
      replay("elsewhere.circles", {"--map", folder("monday"), "--localize", "--start", "unknown"}, "localised");
  EXPECT_NE(localised.err.find(never), std::string::npos) << localised.err;
  EXPECT_EQ(localised.err.find("matching collapsed"), std::string::npos) << localised.err;
  EXPECT_EQ(summary("elsewhere").at("placed").at("found"), false);
  EXPECT_EQ(summary("elsewhere").at("placed").at("last"), "not-here");
  EXPECT_GE(summary("elsewhere").at("placed").at("questions"), 1);
  const std::string told = run({"explain", folder("elsewhere")}).out;
  EXPECT_NE(told.find("never found its place"), std::string::npos) << told;
}

TEST_F(GoOn, AtTheEndByNameItIsAsIfThereHadBeenNoInterruption) {
  const std::string whole = drive_text(grove(1, 50), 0.0, 200, 4);
  const std::size_t middle = whole.find("STEP img1120 ");
  write("whole.circles", whole);
  write("first.circles", whole.substr(0, middle));
  write("second.circles", whole.substr(middle));
  must("whole.circles", {"--association", "known"}, "whole");
  must("first.circles", {"--association", "known"}, "first");
  must("second.circles", {"--association", "known", "--map", folder("first"), "--start", "end"}, "second");
  const auto last_pose = [&](const std::string& name) {
    std::ifstream file(folder(name) / "trajectory.tum");
    std::string line;
    std::getline(file, line);
    double t_s = 0.0, x_m = 0.0, y_m = 0.0, skip = 0.0, qz = 0.0, qw = 0.0;
    while (file >> t_s >> x_m >> y_m >> skip >> skip >> skip >> qz >> qw) continue;
    return Eigen::Vector3d(x_m, y_m, 2.0 * std::atan2(qz, qw));
  };
  EXPECT_LT((last_pose("whole") - last_pose("second")).norm(), 1e-7);
  EXPECT_EQ(summary("whole").at("landmarks"), summary("second").at("landmarks"));
}

// It has no drive.bin: its estimate is restored, and the part of the log it has driven is not driven again.
TEST_F(GoOn, WhatASessionBegunByPlaceDroveOfALogIsPassedOver) {
  write_yesterday();
  const std::string whole = drive_text(grove(1, 50), 2.0, 240, 2);
  write("first.circles", whole.substr(0, whole.find("STEP img1140 ")));
  write("tuesday.circles", whole);
  must("first.circles", {"--map", folder("monday")}, "first");
  ASSERT_EQ(summary("first").at("placed").at("found"), true);
  ASSERT_FALSE(fs::exists(folder("first") / "drive.bin"));
  const Outcome rest = replay("tuesday.circles", {"--map", folder("first"), "--start", "end"}, "rest");
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_NE(rest.err.find("140 scans of the log were driven by the run of --map"), std::string::npos) << rest.err;
  EXPECT_EQ(summary("rest").at("steps"), 100);
  EXPECT_NEAR(summary("rest").at("landmarks").at("mature").get<double>(),
              summary("monday").at("landmarks").at("mature"), 3);

  const Outcome nothing = replay("tuesday.circles", {"--map", folder("rest"), "--start", "end"}, "nothing");
  EXPECT_EQ(nothing.exit_code, 3);
  EXPECT_NE(nothing.err.find("drove the whole log"), std::string::npos) << nothing.err;
}

TEST_F(GoOn, WhoKnowsNamesBeginsWhereTheyTell) {
  write("monday.circles", drive_text(grove(1, 50), 0.0, 300, 1));
  write("tuesday.circles", drive_text(grove(1, 50), 2.0, 240, 2));
  must("monday.circles", {"--association", "known"}, "monday");
  for (const std::string how : {"on", "in"}) {
    std::vector<std::string> words{"--association", "known", "--map", folder("monday")};
    if (how == "in") words.emplace_back("--localize");
    const Outcome outcome = replay("tuesday.circles", words, how);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("tell where the log begins on the map"), std::string::npos) << outcome.err;
    EXPECT_EQ(summary(how).at("landmarks"), summary("monday").at("landmarks")) << how;
  }
  const Outcome as_said =
      replay("monday.circles", {"--association", "known", "--localize", "--map", folder("monday")}, "as_said");
  EXPECT_EQ(as_said.err.find("tell where"), std::string::npos) << "it begins where the log says";
}

TEST_F(GoOn, FromAPoseTheSameLandmarksAreSeenAgain) {
  write_yesterday();
  must("monday.circles", {"--map", folder("monday"), "--start", "0,0,0"}, "again");
  EXPECT_NEAR(summary("again").at("landmarks").at("mature").get<double>(),
              summary("monday").at("landmarks").at("mature"), 2);
}

TEST_F(GoOn, ALocalizerFindsItsPlaceFromAnUnknownStart) {
  write_yesterday();
  write("tuesday.circles", drive_text(grove(1, 50), 2.0, 240, 2));
  must("tuesday.circles", {"--localize", "--map", folder("monday"), "--start", "unknown"}, "found");
  EXPECT_EQ(summary("found").at("placed").at("found"), true);
  EXPECT_EQ(text_of(folder("found") / "map.csv").substr(0, 2), "id");
  EXPECT_FALSE(fs::exists(folder("found") / "map.bin"));
}

TEST_F(GoOn, ALocalizerThatIsWrongFindsOutAndFindsItsPlace) {
  write_yesterday();
  write("tuesday.circles", drive_text(grove(1, 50), 2.0, 240, 2));
  must("tuesday.circles", {"--localize", "--map", folder("monday")},
       "wrong");  // believes that it starts where Monday did
  EXPECT_EQ(summary("wrong").at("placed").at("found"), true);
}

TEST_F(GoOn, WhatIsNoMapToGoOnInEndsWithStatus3AndNamesTheFile) {
  write_yesterday();
  const std::string bytes = text_of(folder("monday") / "map.bin");
  const auto refused = [&](const std::string& because) {
    const Outcome outcome = replay("monday.circles", {"--map", folder("monday")}, "none");
    EXPECT_EQ(outcome.exit_code, 3) << because;
    EXPECT_NE(outcome.err.find("map.bin"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(because), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(folder("none")));
  };
  const auto with = [&](const std::string& spoilt, const std::string& because) {
    std::ofstream(folder("monday") / "map.bin", std::ios::binary) << spoilt;
    refused(because);
  };
  with("", "empty");
  with(bytes.substr(0, bytes.size() / 2), "cut short");
  std::string flipped = bytes;
  flipped[bytes.size() / 2] = static_cast<char>(flipped[bytes.size() / 2] ^ 1);
  with(flipped, "the checksum does not fit");
  std::string newer = bytes;
  newer[8] = 3;
  with(newer, "version 3");
  fs::remove(folder("monday") / "map.bin");
  refused("not there");
  const Outcome nowhere = replay("monday.circles", {"--map", folder("nowhere")}, "none");
  EXPECT_EQ(nowhere.exit_code, 3);
  EXPECT_NE(nowhere.err.find("expected the folder of a run"), std::string::npos) << nowhere.err;
}

TEST_F(GoOn, RunsThatBeganAnywhereAreJoinedToOneMapToGoOnIn) {
  write_yesterday();
  std::vector<Eigen::Vector2d> trees_m = grove(1, 50);
  const auto by_the_road = [](const Eigen::Vector2d& tree_m) { return std::abs(tree_m.norm() - radius_m) < 8.0; };
  trees_m.erase(std::find_if(trees_m.begin(), trees_m.end(), by_the_road));
  write("tuesday.circles", drive_text(trees_m, 2.0, 240, 2));
  write("elsewhere.circles", drive_text(grove(2, 30), 0.0, 200, 3));
  must("tuesday.circles", {}, "tuesday");
  must("elsewhere.circles", {}, "elsewhere");
  const Outcome joined =
      run({"join", folder("monday"), folder("tuesday"), folder("elsewhere"), "--out", folder("week")});
  EXPECT_EQ(joined.exit_code, 0) << joined.err;
  EXPECT_NE(joined.out.find("component 2"), std::string::npos) << joined.out;
  EXPECT_TRUE(fs::exists(folder("week") / "component_2" / "map.bin"));
  EXPECT_FALSE(fs::exists(folder("week") / "component_3"));
  EXPECT_NE(text_of(folder("week") / "joins.csv").find(",accepted,"), std::string::npos);
  EXPECT_NE(text_of(folder("week") / "changes.csv").find(",gone,"), std::string::npos) << "the tree that was felled";
  must("tuesday.circles", {"--map", folder("week")}, "next");
  EXPECT_EQ(summary("next").at("placed").at("found"), true);
}

TEST_F(GoOn, NamesOutliveJoining) {
  const std::vector<std::string> by_name{"--association", "known"};
  write("monday.circles", drive_text(grove(1, 50), 0.0, 300, 1));
  write("tuesday.circles", drive_text(grove(1, 50), 2.0, 240, 2));
  must("monday.circles", by_name, "monday");
  must("tuesday.circles", by_name, "tuesday");
  const Outcome joined = run({"join", folder("monday"), folder("tuesday"), "--out", folder("week")});
  ASSERT_EQ(joined.exit_code, 0) << joined.err;
  EXPECT_EQ(joined.err, "") << "no names contradict where the trees stand";
  EXPECT_NE(text_of(folder("week") / "map.csv").find(",name\n"), std::string::npos);
  for (const bool is_localised : {false, true}) {
    std::vector<std::string> words{"--association", "known", "--map", folder("week")};
    if (is_localised) words.emplace_back("--localize");
    if (!is_localised) words.insert(words.end(), {"--start", "0,0,0"});
    const std::string out = is_localised ? "located" : "gone_on";
    must("monday.circles", words, out);
    EXPECT_NEAR(summary(out).at("nis").at("mean_per_dof").get<double>(), 1.0, 0.2) << out;
  }
  EXPECT_EQ(summary("located").at("association").at("recall"), 1.0);
}

TEST_F(GoOn, WhatIsMissingFromARunToKnowItsDriveByIsSaid) {
  write_yesterday();
  write("tuesday.circles", drive_text(grove(1, 50), 2.0, 240, 2));
  must("tuesday.circles", {}, "tuesday");
  EXPECT_EQ(replay("tuesday.circles", {"--map", folder("monday"), "--start", "end"}, "with").err.find("drive.bin"),
            std::string::npos);
  fs::remove(folder("monday") / "drive.bin");
  const Outcome without = replay("tuesday.circles", {"--map", folder("monday"), "--start", "end"}, "without");
  EXPECT_NE(without.err.find("drive.bin: not there"), std::string::npos) << without.err;
  fs::remove(folder("monday") / "drives.csv");
  const Outcome joined = run({"join", folder("monday"), folder("tuesday"), "--out", folder("week")});
  EXPECT_EQ(joined.exit_code, 0) << joined.err;
  EXPECT_NE(joined.err.find("monday: no drives.csv"), std::string::npos) << joined.err;
  EXPECT_EQ(joined.err.find("tuesday: no drives.csv"), std::string::npos) << joined.err;
}

TEST_F(GoOn, OneMapTwiceIsRefused) {
  write_yesterday();
  write("tuesday.circles", drive_text(grove(1, 50), 2.0, 240, 2));
  must("tuesday.circles", {"--map", folder("monday")}, "tuesday");
  const auto refused = [&](const std::string& other, const std::string& because) {
    const Outcome outcome = run({"join", folder("monday"), other, "--out", folder("none")});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_NE(outcome.err.find(because), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(folder("none")));
  };
  refused(folder("monday"), "the same map as");
  refused(folder("tuesday"), "holds it already");
  refused(folder("nowhere"), "expected the folder of a run");
}

TEST_F(GoOn, AStartFromWhereNothingOfTheMapIsSeenIsWarnedOf) {
  write_yesterday();
  write("tuesday.circles", drive_text(grove(1, 50), 0.0, 240, 2));
  const auto said = [&](const std::string& start) {
    return replay("tuesday.circles", {"--map", folder("monday"), "--start", start}, "at" + start).err;
  };
  EXPECT_NE(said("300,0,0").find("the start given (--start) is wrong"), std::string::npos);
  EXPECT_EQ(said("0,0,0").find("the start given"), std::string::npos);
}

TEST_F(GoOn, ARunThatNeverFoundItsPlaceHoldsNothingOfThatMapAndIsJoinedAsAnyOther) {
  write_yesterday();
  write("elsewhere.circles", drive_text(grove(2, 50), 0.0, 200, 3));
  must("elsewhere.circles", {"--map", folder("monday")}, "elsewhere");
  ASSERT_EQ(summary("elsewhere").at("placed").at("found"), false);
  const Outcome joined = run({"join", folder("monday"), folder("elsewhere"), "--out", folder("both")});
  EXPECT_EQ(joined.exit_code, 0) << joined.err;
  EXPECT_TRUE(fs::exists(folder("both") / "component_2" / "map.bin"));
}

TEST_F(GoOn, AJoinedMapIsNoRunAndHasNoEnd) {
  write_yesterday();
  write("elsewhere.circles", drive_text(grove(2, 50), 0.0, 200, 3));
  must("elsewhere.circles", {}, "elsewhere");
  ASSERT_EQ(run({"join", folder("monday"), folder("elsewhere"), "--out", folder("both")}).exit_code, 0);
  for (const std::string command : {"explain", "evaluate"}) {
    const Outcome outcome = run({command, folder("both")});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_NE(outcome.err.find("joins.csv says how each run was placed"), std::string::npos) << outcome.err;
  }
  const Outcome outcome = replay("monday.circles", {"--map", folder("both"), "--start", "end"}, "none");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("a joined map has no end"), std::string::npos) << outcome.err;
}

TEST_F(GoOn, OfALocalizationThatFoundNoPlaceIsNotSaidThatItMapped) {
  write_yesterday();
  write("elsewhere.circles", drive_text(grove(2, 50), 0.0, 200, 3));
  must("elsewhere.circles", {"--localize", "--map", folder("monday"), "--start", "unknown"}, "located");
  const std::string told = run({"explain", folder("located")}).out;
  EXPECT_NE(told.find("which stays as given"), std::string::npos) << told;
  EXPECT_EQ(told.find("this session only"), std::string::npos) << told;
}

TEST_F(GoOn, AMapOfOneLandmarkIsTooSmallToBeFoundOn) {
  write("one.circles", drive_text({{radius_m, 5.0}}, 0.0, 20, 1));
  must("one.circles", {}, "one");
  const Outcome outcome = replay("one.circles", {"--map", folder("one")}, "none");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("1 mature landmark;"), std::string::npos) << outcome.err;
  const Outcome localized = replay("one.circles", {"--localize", "--map", folder("one"), "--start", "unknown"}, "none");
  EXPECT_EQ(localized.exit_code, 3);
  EXPECT_NE(localized.err.find("cannot be searched"), std::string::npos) << localized.err;
  EXPECT_FALSE(fs::exists(folder("none")));
}

}  // namespace
}  // namespace helixnav::apps
