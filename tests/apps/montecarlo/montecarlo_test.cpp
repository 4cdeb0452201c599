// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class MonteCarlo : public ::testing::Test {
 protected:
  fs::path out(const std::string& name) const { return folder_.path() / name; }

  Outcome campaign(const std::string& name, const std::vector<std::string>& options) const {
    std::vector<std::string> words{"montecarlo", "large-loop", "--out", out(name)};
    words.insert(words.end(), options.begin(), options.end());
    return run(words);
  }

  /// Rows of a campaign without their wall-clock figures.
  std::vector<Json> rows(const std::string& name) const {
    std::vector<Json> rows;
    std::istringstream stream(text_of(out(name) / "runs.jsonl"));
    for (std::string line; std::getline(stream, line);) {
      rows.push_back(Json::parse(line));
      rows.back().erase("wall");
    }
    return rows;
  }
  Json summary(const std::string& name) const { return Json::parse(text_of(out(name) / "summary.json")); }

  void append(const std::string& name, const std::string& text) const {
    std::ofstream(out(name) / "runs.jsonl", std::ios::app) << text;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(MonteCarlo, GivesTheSameRowsForAnyNumberOfJobs) {
  ASSERT_EQ(campaign("one", {"--runs", "3", "--jobs", "1"}).exit_code, 0);
  ASSERT_EQ(campaign("two", {"--runs", "3", "--jobs", "2"}).exit_code, 0);
  EXPECT_EQ(rows("one").size(), 3u);
  EXPECT_EQ(rows("one"), rows("two"));
  Json first = summary("one");
  Json second = summary("two");
  first.erase("wall");
  second.erase("wall");
  EXPECT_EQ(first, second);
}

TEST_F(MonteCarlo, GoesOnAfterAKillAsIfThereHadBeenNone) {
  ASSERT_EQ(campaign("whole", {"--runs", "3", "--first-seed", "7"}).exit_code, 0);
  ASSERT_EQ(campaign("cut", {"--runs", "2", "--first-seed", "8"}).exit_code, 0);
  append("cut", "{\"seed\":10,\"verdi");  // the process died while writing
  const Outcome outcome = campaign("cut", {"--runs", "3", "--first-seed", "7"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(rows("cut"), rows("whole"));
}

TEST_F(MonteCarlo, DrivesNoSeedThatTheFolderHolds) {
  ASSERT_EQ(campaign("run", {"--runs", "1"}).exit_code, 0);
  append("run", "{\"seed\":2,\"verdict\":\"failed\",\"error\":\"made up\"}\n");
  ASSERT_EQ(campaign("run", {"--runs", "2"}).exit_code, 0);
  EXPECT_EQ(rows("run").at(1).value("error", ""), "made up");
  EXPECT_EQ(summary("run").at("failed").at("count"), 1);
}

TEST_F(MonteCarlo, KeepsTheRunsThatCameToTheirEndWhenInterrupted) {
  Program program({"montecarlo", "large-loop", "--runs", "1000000", "--jobs", "2", "--out", out("run")});
  constexpr int patience_ms = 30'000;
  for (int ms = 0; ms < patience_ms && complete_lines(out("run") / "runs.jsonl") < 1; ++ms) ::usleep(1000);
  program.send(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("interrupted"), std::string::npos) << outcome.err;
  EXPECT_GE(rows("run").size(), 1u);
  // In the middle of a long step the program has no time to write a summary.
  if (!fs::exists(out("run") / "summary.json")) return;
  EXPECT_EQ(summary("run").at("runs"), rows("run").size());
}

TEST_F(MonteCarlo, RefusesAFolderOfAnotherCampaignAndNamesTheDifference) {
  ASSERT_EQ(campaign("run", {"--runs", "1"}).exit_code, 0);
  const std::string before = text_of(out("run") / "runs.jsonl");
  const Outcome other = campaign("run", {"--runs", "1", "--association.extraneous_per_scan", "3"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_NE(other.err.find("association.extraneous_per_scan = 3"), std::string::npos) << other.err;
  EXPECT_NE(other.err.find("--overwrite"), std::string::npos) << other.err;
  const Outcome scenario = run({"montecarlo", "circuit", "--runs", "1", "--out", out("run")});
  EXPECT_EQ(scenario.exit_code, 3);
  EXPECT_NE(scenario.err.find("circuit"), std::string::npos) << scenario.err;
  EXPECT_EQ(text_of(out("run") / "runs.jsonl"), before);

  const Outcome anew = campaign("run", {"--runs", "1", "--association.extraneous_per_scan", "3", "--overwrite"});
  EXPECT_EQ(anew.exit_code, 0) << anew.err;
}

TEST_F(MonteCarlo, RefusesAFolderOfOtherThings) {
  const fs::path notes = folder_.write("run/notes.txt", "mine");
  const Outcome outcome = campaign("run", {"--runs", "1"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.err.find("not empty"), std::string::npos) << outcome.err;
  EXPECT_EQ(names_in(out("run")), std::set<std::string>{"notes.txt"});
}

TEST_F(MonteCarlo, RefusesOptionsOutOfTheirRange) {
  for (const std::vector<std::string>& options :
       {std::vector<std::string>{"--runs", "0"}, {"--jobs", "0"}, {"--first-seed", "-1"}, {"--runs", "many"}}) {
    const Outcome outcome = campaign("run", options);
    EXPECT_EQ(outcome.exit_code, 2) << options.front();
    EXPECT_NE(outcome.err.find(options.front()), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(out("run")));
  }
  const Outcome scenario = run({"montecarlo", "large-lop", "--out", out("run")});
  EXPECT_EQ(scenario.exit_code, 2);
  EXPECT_NE(scenario.err.find("did you mean 'large-loop'"), std::string::npos) << scenario.err;
}

/// A closing as written in a line of runs.jsonl.
std::string row(int seed, const std::string& verdict, double nees, double metres) {
  const Json pose = {{"nees", nees}, {"position_error_m", 0.1}, {"absolute_position_error_m", 0.2}};
  Json closure = pose;
  closure.update({{"after_reentry_m", metres}, {"pairs", 10}, {"wrong_pairs", verdict == "false" ? 3 : 0}});
  const Json json = {{"seed", seed},
                     {"verdict", verdict},
                     {"diverged_after_closure", false},
                     {"closures", {closure}},
                     {"returns", {{{"error_before_m", seed}}}},
                     {"spacing_m", 8.5},
                     {"end", pose},
                     {"trees_seen", 100},
                     {"duplicates", 1},
                     {"wrong_before_trigger", 0}};
  return json.dump() + '\n';
}

TEST_F(MonteCarlo, SumsUpWithIntervalsAndBands) {
  ASSERT_EQ(campaign("run", {"--runs", "1"}).exit_code, 0);
  std::ofstream(out("run") / "runs.jsonl", std::ios::trunc) << std::flush;
  for (int seed = 1; seed <= 20; ++seed) append("run", row(seed, seed < 20 ? "closed" : "false", 3.0, 10.0 + seed));
  ASSERT_EQ(campaign("run", {"--runs", "20"}).exit_code, 0);
  const Json s = summary("run");
  EXPECT_EQ(s.at("closed").at("count"), 19);
  EXPECT_NEAR(s.at("closed").at("interval_95_percent").at(0), 75.13, 0.01);  // published table: 19 of 20
  EXPECT_NEAR(s.at("closed").at("interval_95_percent").at(1), 99.87, 0.01);
  EXPECT_NEAR(s.at("undecided").at("interval_95_percent").at(0), 0.0, 1e-12);
  EXPECT_NEAR(s.at("undecided").at("interval_95_percent").at(1), 16.84, 0.01);  // 0 of 20
  EXPECT_EQ(s.at("error_at_return_exceeds_spacing").at("count"), 12);           // 9 m to 20 m
  EXPECT_NEAR(s.at("metres_to_closure").at("median"), 20.0, 1e-12);             // of 11 … 29, without the false one
  EXPECT_NEAR(s.at("metres_to_closure").at("p90"), 27.2, 1e-12);
  EXPECT_NEAR(s.at("nees_at_closing").at("mean"), 3.0, 1e-12);
  EXPECT_NEAR(s.at("nees_at_closing").at("band_95").at(0), 40.482 / 20.0, 1e-3);  // χ² with 60 degrees of freedom
  EXPECT_NEAR(s.at("nees_at_closing").at("band_95").at(1), 83.298 / 20.0, 1e-3);
  EXPECT_EQ(s.at("closures").at("wrong_pairs"), 3.0);
  EXPECT_NEAR(s.at("duplicates").at("percent_of_trees"), 1.0, 1e-12);
}

}  // namespace
}  // namespace helixnav::apps
