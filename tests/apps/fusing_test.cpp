// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "real_data.hpp"
#include "sanitized.hpp"

namespace helixnav::apps {
namespace {

using nlohmann::json;

class Fusing : public testing::RealDataTest {
 protected:
  json summary_of(std::vector<std::string> words) {
    const auto out = folder_.path() / "run";
    words.insert(words.end(), {"--out", out.string(), "--overwrite"});
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    said_ = outcome.out;
    return json::parse(text_of(out / "summary.json"));
  }

  testing::TemporaryFolder folder_;
  std::string said_;
};

TEST_F(Fusing, OfPlazaRangesEstimatesTheirScaleAndNavigatesWithinItsLimit) {
  find_real_data("plaza");
  if (IsSkipped()) return;
  const json error = summary_of({"replay", path_, "--association", "known"}).at("error");
  EXPECT_LE(error.at("rmse_m"), 0.5) << "promised: 1.5 m";
  EXPECT_EQ(error.at("fixes_left_out"), 0);
  EXPECT_GE(error.at("fixes_used"), 9600);
  const std::string words = "range scale estimated from the log: ";
  ASSERT_NE(said_.find(words), std::string::npos) << said_;
  // Against the true beacons and positions the ranges are long by 1.070.
  EXPECT_NEAR(std::stod(said_.substr(said_.find(words) + words.size())), 1.070, 0.005);
}

TEST_F(Fusing, OfVictoriaParksGpsBringsTheDriveNearerToTheFixes) {
  find_real_data("victoria_park/raw/victoria_park_ascii.zip");
  if (IsSkipped()) return;
  const double fused_m = summary_of({"replay", path_, "--gps", "fuse"}).at("error").at("rmse_m");
  if (!support::sanitized) {
    EXPECT_LT(fused_m, 0.9 * summary_of({"replay", path_}).at("error").at("rmse_m").get<double>());
  }
  EXPECT_LT(fused_m, 1.3);
}

}  // namespace
}  // namespace helixnav::apps
