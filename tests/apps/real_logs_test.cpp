// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "real_data.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// One drive through each real log with the default settings, association unknown, as a user would run it. The limits
// are the ones the project promises.
class RealLog : public testing::RealDataTest {
 protected:
  void replay(const fs::path& log) const {
    const Outcome outcome = run({"replay", log, "--out", folder_.path() / "run"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  json summary() const { return json::parse(text_of(folder_.path() / "run" / "summary.json")); }
  json evaluate(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"evaluate", folder_.path() / "run", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return json::parse(outcome.out);
  }

  testing::TemporaryFolder folder_;
};

TEST_F(RealLog, OfVictoriaParkIsNavigatedWithinItsLimits) {
  find_real_data("victoria_park/raw/victoria_park_ascii.zip");
  if (IsSkipped()) return;
  replay(path_);
  const fs::path all_fixes = path_.parent_path() / "aa3_gpsx.mat";
  const json error = evaluate({"--truth", all_fixes}).at("error");
  EXPECT_LE(error.at("rmse_m"), 1.6);
  EXPECT_LE(error.at("median_m"), 1.1);
  EXPECT_LE(error.at("fixes_left_out"), 10);
  EXPECT_GE(error.at("fixes_used"), 4400);
  EXPECT_LE(summary().at("landmarks").at("mature"), 350);
  EXPECT_GE(summary().at("landmarks").at("mature"), 150) << "a map with few landmarks is no map of the park";
}

TEST_F(RealLog, OfTheCarParkIsNavigatedWithinItsLimits) {
  find_real_data("carpark/raw/data_set.mat");
  if (IsSkipped()) return;
  replay(path_);
  const json evaluation = evaluate({});
  EXPECT_LE(evaluation.at("error").at("rmse_m"), 0.30);
  const json& beacons = evaluation.at("landmark_error");
  EXPECT_LE(beacons.at("rmse_m"), 0.15);
  EXPECT_EQ(beacons.at("pairs"), 15);
  EXPECT_EQ(beacons.at("missing"), 0);
  EXPECT_EQ(beacons.at("duplicates"), 0);
  EXPECT_EQ(beacons.at("spurious"), 0);
  EXPECT_EQ(summary().at("landmark_error"), beacons) << "summary.json and evaluate say the same";
}

}  // namespace
}  // namespace helixnav::apps
