// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "small_logs.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Table = std::vector<std::vector<double>>;

/// Cells of a file in the run folder, without its header; words become 0.
Table table_of(const fs::path& file) {
  Table table;
  std::istringstream stream(text_of(file));
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream cells(line);
    table.emplace_back();
    for (std::string cell; cells >> cell;) table.back().push_back(std::strtod(cell.c_str(), nullptr));
  }
  return table;
}

/// A circle of 40 steps; its clock is the index of the pose.
class BlackoutTest : public ::testing::Test {
 protected:
  void SetUp() override { log_ = folder_.write("circle.txt", circle_graph(steps_)); }
  fs::path out(const std::string& name) const { return folder_.path() / name; }
  Outcome replay(const std::string& name, const std::vector<std::string>& options) const {
    std::vector<std::string> words{"replay", log_, "--association", "known", "--out", out(name)};
    words.insert(words.end(), options.begin(), options.end());
    return run(words);
  }
  void must_replay(const std::string& name, const std::vector<std::string>& options) const {
    const Outcome outcome = replay(name, options);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  /// Time of scan k, as printed.
  std::string time(std::size_t k) const {
    std::ostringstream text;
    text.precision(15);
    text << table_of(out("plain") / "trajectory.tum").at(k).at(0);
    return text.str();
  }
  std::string window(std::size_t begin, std::size_t end) const { return time(begin) + ":" + time(end); }

  static constexpr int steps_ = 40;
  testing::TemporaryFolder folder_;
  fs::path log_;
};

TEST_F(BlackoutTest, WithholdsTheScansOfItsWindowsAndNoOthers) {
  must_replay("plain", {});
  must_replay("blind", {"--blackout", window(10, 13), "--blackout=" + window(20, 21)});
  std::vector<int> seen(steps_ + 1, 0);
  for (const auto& row : table_of(out("blind") / "associations.csv")) ++seen.at(static_cast<std::size_t>(row.at(0)));
  for (std::size_t k = 0; k < seen.size(); ++k) {
    EXPECT_EQ(seen[k], (k >= 10 && k < 13) || k == 20 ? 0 : 1) << "scan " << k;
  }
  const json summary = json::parse(text_of(out("blind") / "summary.json"));
  EXPECT_EQ(summary.at("blackout").at("scans"), 4);
  EXPECT_EQ(summary.at("steps"), steps_ + 1);
  const json manifest = json::parse(text_of(out("blind") / "manifest.json"));
  EXPECT_NE(manifest.at("command").get<std::string>().find("--blackout " + window(10, 13)), std::string::npos);
}

TEST_F(BlackoutTest, LeavesLabelsToTheScansThatHaveThem) {
  must_replay("plain", {});
  must_replay("blind", {"--blackout", window(10, 13)});
  const Table labels = table_of(out("blind") / "truth_labels.csv");
  const Table associations = table_of(out("blind") / "associations.csv");
  ASSERT_EQ(labels.size(), associations.size());
  for (std::size_t i = 0; i < labels.size(); ++i) EXPECT_EQ(labels[i][0], associations[i][0]);
}

TEST_F(BlackoutTest, GoesOnByOdometryWhichGrowsTheCovariance) {
  must_replay("plain", {});
  must_replay("blind", {"--blackout", window(10, 20)});
  const Table trajectory = table_of(out("blind") / "trajectory.tum");
  const Table health = table_of(out("blind") / "health.csv");
  const Table plain = table_of(out("plain") / "trajectory.tum");
  ASSERT_EQ(trajectory.size(), plain.size());
  for (std::size_t k = 0; k < plain.size(); ++k) {
    EXPECT_EQ(trajectory[k][0], plain[k][0]) << "scan " << k;
    EXPECT_NEAR(trajectory[k][1], plain[k][1], 0.05) << "scan " << k;
    EXPECT_NEAR(trajectory[k][2], plain[k][2], 0.05) << "scan " << k;
  }
  for (std::size_t k = 10; k < 20; ++k) {
    EXPECT_NEAR(health[k][8] - health[k - 1][8], 1.0 / (500.0 * 500.0), 1e-12) << "heading variance at scan " << k;
  }
  EXPECT_LT(health[20][8], health[19][8]);
}

TEST_F(BlackoutTest, UntilTheEndIsDeadReckoningAlone) {
  must_replay("plain", {});
  must_replay("blind", {"--blackout", time(1) + ":1e9"});
  const Table trajectory = table_of(out("blind") / "trajectory.tum");
  double x_m = 0.0, y_m = 0.0, heading_rad = 0.0;
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    EXPECT_NEAR(trajectory[k][1], x_m, 1e-9) << "scan " << k;
    EXPECT_NEAR(trajectory[k][2], y_m, 1e-9) << "scan " << k;
    x_m += 0.19999 * std::cos(heading_rad) - 0.001 * std::sin(heading_rad);
    y_m += 0.19999 * std::sin(heading_rad) + 0.001 * std::cos(heading_rad);
    heading_rad += 0.01;
  }
}

TEST_F(BlackoutTest, CanBeSmoothedAndLocalisedThrough) {
  must_replay("plain", {});
  must_replay("blind", {"--smooth", "--blackout", window(10, 13)});
  EXPECT_TRUE(fs::exists(out("blind") / "trajectory_final.tum"));
  must_replay("located", {"--localize", "--map", out("plain"), "--blackout", window(10, 13)});
  EXPECT_EQ(table_of(out("located") / "trajectory.tum").size(), static_cast<std::size_t>(steps_ + 1));
}

TEST_F(BlackoutTest, ThatIsNoWindowIsMisuse) {
  for (const std::string window : {"5:5", "7:6", "5", "a:b", "1:", ":2", "nan:5", "1:inf", "1:2:3"}) {
    const Outcome outcome = replay("bad", {"--blackout", window});
    EXPECT_EQ(outcome.exit_code, 2) << window;
    EXPECT_NE(outcome.err.find("--blackout"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("'" + window + "'"), std::string::npos) << outcome.err;
  }
  EXPECT_FALSE(fs::exists(out("bad")));
}

TEST_F(BlackoutTest, WithoutAScanNamesTheTimesOfTheLog) {
  must_replay("plain", {});
  const Outcome outcome = replay("bad", {"--blackout", "1e6:2e6"});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.err;
  EXPECT_NE(outcome.err.find("from " + time(0) + " to " + time(steps_) + " s"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(out("bad")));
}

}  // namespace
}  // namespace helixnav::apps
