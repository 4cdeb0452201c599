// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>
#include <csignal>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "real_data.hpp"
#include "small_logs.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Words = std::vector<std::string>;

class TeamReplay : public testing::RealDataTest {
 protected:
  void SetUp() override { find_real_data("mrclam/dataset6"); }
  Outcome replay(const Words& options, const std::string& name = "team") const {
    Words words{"replay", path_.string(), "--quiet", "--out", (folder_.path() / name).string()};
    words.insert(words.end(), options.begin(), options.end());
    return run(words);
  }
  json summary() const { return json::parse(text_of(folder_.path() / "team" / "summary.json")); }

  testing::TemporaryFolder folder_;
};

/// A suite of its own, which the sanitizers skip: it takes over a minute with them.
class TeamWholeReplay : public TeamReplay {};

TEST_F(TeamWholeReplay, KeepsFiveRobotsWithin15CentimetresOfTheirTruth) {
  const Outcome outcome = replay({});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json figures = summary();
  double sum_m = 0.0;
  for (const json& robot : figures["robots"]) {
    const double rmse_m = robot["position_error_m"]["rmse"];
    EXPECT_LT(rmse_m, 0.20) << robot["robot"];
    sum_m += rmse_m;
  }
  EXPECT_LT(sum_m / 5.0, 0.15);
  EXPECT_LT(figures["landmarks"][0]["aligned_rmse_m"], 0.09);
  EXPECT_EQ(figures["misread"], 6);
  EXPECT_EQ(names_in(folder_.path() / "team"),
            (std::set<std::string>{"joins.csv", "map.csv", "report.html", "robot_1", "robot_2", "robot_3", "robot_4",
                                   "robot_5", "sightings.csv", "summary.json"}));
  const Outcome robot = run({"evaluate", (folder_.path() / "team" / "robot_3").string()});
  EXPECT_EQ(robot.exit_code, 0) << robot.err;
}

TEST_F(TeamWholeReplay, KeepsFiveRobotsWithin20CentimetresWithoutNames) {
  const Outcome outcome = replay({"--association", "unknown"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  double sum_m = 0.0;
  const json figures = summary();
  for (const json& robot : figures["robots"]) {
    const double rmse_m = robot["position_error_m"]["rmse"];
    EXPECT_LT(rmse_m, 0.20) << robot["robot"];
    sum_m += rmse_m;
  }
  EXPECT_LT(sum_m / 5.0, 0.16);
}

TEST_F(TeamReplay, LeavesTheFoldersOfWhatWasDrivenWhenInterrupted) {
  Program program({"replay", path_.string(), "--out", (folder_.path() / "team").string()});
  constexpr int patience_ms = 30'000;
  for (int ms = 0; ms < patience_ms && !program.catches(SIGINT); ++ms) ::usleep(1000);
  program.send(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("interrupted"), std::string::npos) << outcome.err;
  EXPECT_TRUE(fs::exists(folder_.path() / "team" / "summary.json"));
  EXPECT_TRUE(fs::exists(folder_.path() / "team" / "robot_1"));
}

TEST_F(TeamReplay, FindsOneFrameFromUnknownStarts) {
  const Outcome outcome = replay({"--robots", "1,3", "--unknown-starts"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json figures = summary();
  EXPECT_EQ(figures["joins"], 1);
  EXPECT_EQ(figures["robots"][0]["component"], 1);
  EXPECT_EQ(figures["robots"][1]["component"], 1);
  EXPECT_EQ(complete_lines(folder_.path() / "team" / "joins.csv"), 2u);
}

TEST_F(TeamReplay, RefusesOptionsOfOneRobotBeforeAnythingIsWritten) {
  for (const Words& options : {Words{"--smooth"}, Words{"--association", "jcbb"}, Words{"--filter", "fastslam"},
                               Words{"--landmarks.mature_looks", "3"}}) {
    const Outcome outcome = replay(options);
    EXPECT_EQ(outcome.exit_code, 2) << options.front() << outcome.err;
    EXPECT_NE(outcome.err.find("several robots"), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "team"));
  }
  for (const Words& options : {Words{"--robots", "1,1"}, Words{"--robots", "9"}}) {
    const Outcome outcome = replay(options);
    EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "team"));
  }
}

TEST(TeamOptions, AreRefusedForALogOfOneRobot) {
  const testing::TemporaryFolder folder;
  const fs::path log = folder.write("circle.txt", circle_graph(20));
  for (const Words& options : {Words{"--robots", "1"}, Words{"--unknown-starts"}, Words{"--association", "unknown"}}) {
    Words words{"replay", log.string(), "--quiet", "--out", (folder.path() / "out").string()};
    words.insert(words.end(), options.begin(), options.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find("several robots"), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(folder.path() / "out"));
  }
}

TEST(TeamSimulation, BringsFourRobotsOfUnknownStartIntoOneFrame) {
  const testing::TemporaryFolder folder;
  const fs::path out = folder.path() / "four";
  const Outcome outcome =
      run({"simulate", "team", "--robots", "4", "--unknown-starts", "--quiet", "--out", out.string()});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json figures = json::parse(text_of(out / "summary.json"));
  EXPECT_EQ(figures["joins"], 3);
  ASSERT_EQ(figures["robots"].size(), 4u);
  for (const json& robot : figures["robots"]) {
    EXPECT_EQ(robot["component"], 1);
    EXPECT_EQ(robot["alone"], false);
  }
  EXPECT_LT(figures["landmarks"][0]["aligned_rmse_m"], 0.2);
  EXPECT_FALSE(figures["robots"][0].contains("in_frame_since_s"));
  const Outcome team = run({"evaluate", out.string()});
  EXPECT_EQ(team.exit_code, 3);
  EXPECT_NE(team.err.find("each has a run folder of its own: " + (out / "robot_1").string()), std::string::npos);
  EXPECT_EQ(run({"evaluate", (out / "robot_1").string()}).err, "");
  // Before it joined the frame of robot 1 its covariances refer to another frame.
  const Outcome robot = run({"evaluate", (out / "robot_2").string(), "--json"});
  EXPECT_NE(robot.err.find("when the robot came into the frame of its team"), std::string::npos) << robot.err;
  EXPECT_LT(json::parse(robot.out)["nees"]["mean"], 2.0 * figures["robots"][1]["nees_mean"].get<double>());
}

TEST(TeamSimulation, RefusesOptionsOfOneRobotAndOthersThoseOfATeam) {
  const testing::TemporaryFolder folder;
  const std::string out = (folder.path() / "out").string();
  for (const Words& options :
       {Words{"team", "--day", "3"}, Words{"team", "--filter", "fastslam"}, Words{"team", "--robots", "1"},
        Words{"large-loop", "--robots", "3"}, Words{"large-loop", "--association", "unknown"}}) {
    Words words{"simulate", "--quiet", "--out", out};
    words.insert(words.end(), options.begin(), options.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 2) << options[1] << outcome.err;
    EXPECT_FALSE(fs::exists(out));
  }
}

// In a world of seed 1840 a step of the least squares puts a landmark into a sensor.
TEST(TeamCampaign, JoinsWhatIsSharedAndNothingElse) {
  const testing::TemporaryFolder folder;
  const std::string out = (folder.path() / "campaign").string();
  const Outcome outcome =
      run({"montecarlo", "team", "--first-seed", "1840", "--runs", "1", "--jobs", "1", "--quiet", "--out", out});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const json figures = json::parse(text_of(folder.path() / "campaign" / "summary.json"));
  for (const char* kind : {"shared", "apart", "chain", "orchard"})
    EXPECT_EQ(figures[kind]["false"]["count"], 0) << kind;
  for (const char* kind : {"shared", "apart", "chain", "orchard"}) EXPECT_EQ(figures[kind]["failed"], 0) << kind;
  EXPECT_GE(figures["shared"]["joined"]["count"], 1);
  EXPECT_EQ(complete_lines(folder.path() / "campaign" / "runs.csv"), 5u);
}

TEST(TeamCampaignParts, AreTheCampaignThatWasNotDivided) {
  const testing::TemporaryFolder folder;
  const auto drive = [&](const std::string& name, const std::string& first, const std::string& runs) {
    const std::string out = (folder.path() / name).string();
    const Outcome outcome =
        run({"montecarlo", "team", "--first-seed", first, "--runs", runs, "--jobs", "1", "--quiet", "--out", out});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return out;
  };
  const std::string whole = drive("whole", "21", "2");
  const std::string second = drive("second", "22", "1");
  const std::string first = drive("first", "21", "1");
  const std::string merged = (folder.path() / "merged").string();
  const Outcome outcome = run({"montecarlo", "--merge", second, first, "--out", merged});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* file : {"manifest.json", "runs.csv", "summary.json"}) {
    EXPECT_EQ(text_of(fs::path(merged) / file), text_of(fs::path(whole) / file)) << file;
  }
  const std::string later = drive("later", "24", "1");
  const Outcome apart = run({"montecarlo", "--merge", whole, later, "--out", merged, "--overwrite"});
  EXPECT_EQ(apart.exit_code, 3);
  EXPECT_NE(apart.err.find("seeds 23 are in none of the parts"), std::string::npos) << apart.err;
  const Outcome twice = run({"montecarlo", "--merge", whole, first, "--out", merged, "--overwrite"});
  EXPECT_EQ(twice.exit_code, 3);
  EXPECT_NE(twice.err.find("seed 21 is in"), std::string::npos) << twice.err;
}

}  // namespace
}  // namespace helixnav::apps
