// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
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

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

std::string line_of(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) line += (line.empty() ? "" : ",") + cell;
  return line + '\n';
}

/// Rewrites a table line by line; the header stays.
template <typename Change>
void rewrite(const fs::path& file, const Change& change) {
  std::istringstream stream(text_of(file));
  std::string line;
  std::getline(stream, line);
  std::string text = line + '\n';
  while (std::getline(stream, line)) {
    std::vector<std::string> cells = cells_of(line);
    change(cells);
    text += line_of(cells);
  }
  std::ofstream(file, std::ios::binary) << text;
}

/// Gives most observations of every landmark to a second one, 1000 + id, that a closing in the last step merges with the
/// first: what a late loop closure leaves behind.
void split_landmarks(const fs::path& run, bool record_merges) {
  std::vector<std::string> ids;
  rewrite(run / "map.csv", [&](const std::vector<std::string>& cells) { ids.push_back(cells[0]); });
  rewrite(run / "associations.csv", [](std::vector<std::string>& cells) {
    if (std::stoi(cells[0]) > 5 && cells[2] != "-1") cells[2] = std::to_string(1000 + std::stoi(cells[2]));
  });
  if (!record_merges) return;
  const std::string last = std::to_string(complete_lines(run / "health.csv") - 2);
  std::ofstream merges(run / "merges.csv", std::ios::app);
  for (const std::string& id : ids) merges << last << ',' << id << ',' << 1000 + std::stoi(id) << '\n';
  rewrite(run / "health.csv", [&](std::vector<std::string>& cells) {
    constexpr std::size_t merge_rows = 16;
    if (cells[0] == last) cells[merge_rows] = std::to_string(ids.size());
  });
}

class MergedRun : public ::testing::Test {
 protected:
  double chi2_started_from(const std::string& run_name) {
    const fs::path out = folder_.path() / ("from-" + run_name);
    const Outcome outcome = run({"smooth", log_, "--start", folder_.path() / run_name, "--out", out});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(text_of(out / "summary.json")).at("chi2_start").get<double>();
  }

  testing::TemporaryFolder folder_;
  std::string log_ = folder_.write("circle.txt", circle_graph(300)).string();
};

TEST_F(MergedRun, StartsASmootherFromTheLandmarksThatWereKept) {
  for (const char* name : {"plain", "merged", "split"}) {
    const fs::path out = folder_.path() / name;
    ASSERT_EQ(run({"replay", log_, "--association", "known", "--quiet", "--out", out}).exit_code, 0);
    rewrite(out / "map.csv",
            [](std::vector<std::string>& cells) { cells[1] = std::to_string(std::stod(cells[1]) + 1); });
  }
  split_landmarks(folder_.path() / "merged", true);
  split_landmarks(folder_.path() / "split", false);
  const double plain = chi2_started_from("plain");
  EXPECT_GT(plain, 1000.0) << "every landmark starts a metre off";
  EXPECT_EQ(chi2_started_from("merged"), plain);
  EXPECT_LT(chi2_started_from("split"), 0.01 * plain) << "without the merges nobody knows where the run had them";
}

}  // namespace
}  // namespace helixnav::apps
