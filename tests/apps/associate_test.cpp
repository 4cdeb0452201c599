// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <sstream>
#include <string>
#include <vector>

#include <unistd.h>

#include <gtest/gtest.h>

#include "program.hpp"
#include "real_data.hpp"
#include "sanitized.hpp"
#include "small_logs.hpp"

namespace helixnav::apps {
namespace {

using Words = std::vector<std::string>;

class Associate : public testing::RealDataTest {
 protected:
  static void expect_refused(const Words& more, int code, const Words& said) {
    Words words{"associate"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, code) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    for (const std::string& word : said) {
      EXPECT_NE(outcome.err.find(word), std::string::npos) << "no \"" << word << "\" in: " << outcome.err;
    }
  }
  testing::TemporaryFolder folder_;
};

/// The lines of a text, each as its words.
std::vector<Words> words_by_line(const std::string& text) {
  std::vector<Words> lines;
  std::istringstream all(text);
  for (std::string line; std::getline(all, line);) {
    std::istringstream words(line);
    lines.emplace_back();
    for (std::string word; words >> word;) lines.back().push_back(word);
  }
  return lines;
}

TEST_F(Associate, PrintsOneLineAMethodForAScenario) {
  const Outcome outcome = run({"associate", "ihgr-circle", "--runs", "2", "--seed", "11"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::vector<Words> lines = words_by_line(outcome.out);
  ASSERT_EQ(lines.size(), 8u);
  EXPECT_EQ(lines[0][0], "method");
  EXPECT_EQ(lines[1][0], "nearest-neighbour");
  EXPECT_EQ(lines[7][0], "ihgr-likelihood-ratio");
}

TEST_F(Associate, ComparesTheMethodsNamed) {
  const Outcome outcome = run({"associate", "ihgr-circle-close", "--methods", "jcbb,likelihood-ratio"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::vector<Words> lines = words_by_line(outcome.out);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[1][0], "jcbb");
  EXPECT_NE(lines[1][1], "0") << "nobody tells features apart that stand within the noise";
}

TEST_F(Associate, PrintsTheMatchingMatrixOfAScan) {
  const auto log = folder_.write("circle.txt", circle_graph(5));
  const Outcome outcome = run({"associate", log, "--scan", "3"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::vector<Words> lines = words_by_line(outcome.out);
  ASSERT_EQ(lines.size(), 4u) << outcome.out;
  EXPECT_EQ(lines[1], (Words{"1", "0"}));
  EXPECT_EQ(lines[2], (Words{"1", "1", "0"}));
  EXPECT_EQ(lines[3], (Words{"0", "0", "0"}));
}

TEST_F(Associate, RefusesWhatItCannotUse) {
  expect_refused({"ihgr-circel"}, 3, {"neither a log nor a scenario", "'ihgr-circle'"});
  expect_refused({"ihgr-circle", "--methods", "jbcc"}, 2, {"unknown name 'jbcc'", "did you mean 'jcbb'"});
  expect_refused({"ihgr-circle", "--run", "3"}, 2, {"unknown option '--run'", "did you mean '--runs'"});
  expect_refused({"ihgr-circle", "--runs", "0"}, 2, {"--runs", "from 1 to 100000"});
  expect_refused({"ihgr-circle", "--scan", "9999"}, 3, {"--scan 9999 is beyond the last of 361 scans"});
  expect_refused({write_zip(folder_.path() / "release.zip", small_release())}, 3, {"no labels", "--scan"});
  expect_refused({"ihgr-circle", "--gps", "fuse"}, 2, {"--gps fuse"});
  expect_refused({}, 2, {"INPUT is required"});
}

// The first third of DLR run e, before the building's loops close; the limits are the ones the project promises.
TEST_F(Associate, KeepsToTheLabelsOfTheDlrRunInsideALap) {
  find_real_data("dlr/raw/map.circles");
  if (IsSkipped()) return;
  std::istringstream all(text_of(path_));
  std::string lap;
  int steps = 0;
  for (std::string line; steps <= 1000 && std::getline(all, line);) {
    steps += line.rfind("STEP", 0) == 0;
    if (steps <= 1000) lap += line + '\n';
  }
  const Outcome outcome = run({"associate", folder_.write("lap.circles", lap), "--methods", "likelihood-ratio"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Words row = words_by_line(outcome.out).at(1);
  ASSERT_GE(row.size(), 6u);
  const std::size_t last = row.size() - 1;
  EXPECT_GE(std::stod(row[last - 5]), 99.5) << "pairwise precision";
  EXPECT_GE(std::stod(row[last - 4]), 90.0) << "pairwise recall";
  EXPECT_LE(std::stod(row[last - 2]), 1.1) << "map landmarks for each true one";
}

// The limits are the ones the project promises; with loops left open the recall is 81 %. Under the sanitizers the lap
// above has to suffice.
TEST_F(Associate, ClosesTheLoopsOfTheDlrRun) {
  if (support::sanitized) return;
  find_real_data("dlr/raw/map.circles");
  if (IsSkipped()) return;
  const Outcome outcome = run({"associate", path_, "--methods", "likelihood-ratio"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const Words row = words_by_line(outcome.out).at(1);
  ASSERT_GE(row.size(), 6u);
  const std::size_t last = row.size() - 1;
  EXPECT_GE(std::stod(row[last - 5]), 99.5) << "pairwise precision";
  EXPECT_GE(std::stod(row[last - 4]), 90.0) << "pairwise recall";
  EXPECT_LE(std::stod(row[last - 2]), 1.1) << "map landmarks for each true one";
}

TEST_F(Associate, EndsWithATableWhenInterrupted) {
  Program program({"associate", "ihgr-circle", "--runs", "100000"});
  constexpr int patience_ms = 30'000;
  for (int ms = 0; ms < patience_ms && !program.catches(SIGINT); ++ms) ::usleep(1000);
  program.send(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
  EXPECT_EQ(outcome.out.rfind("method", 0), 0u) << outcome.out;
}

}  // namespace
}  // namespace helixnav::apps
