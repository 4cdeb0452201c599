// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "helixnav/core/odometry.hpp"
#include "helixnav/supervisor/navigator.hpp"
#include "program.hpp"
#include "real_data.hpp"
#include "replay/fuse_gps.hpp"
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

// Ten metres a second, a scan every half second, a fix 0.3 s after it: three metres behind is where the vehicle was.
TEST(FuseGps, UsesAFixWhereTheVehicleWasThen) {
  core::Recording recording;
  recording.events.emplace_back(core::Scan{});
  for (int k = 1; k <= 40; ++k) {
    core::Odometry moved = core::no_motion(core::nanoseconds_from_seconds(0.5 * k));
    moved.T_before_after.x_m = 5.0;
    moved.covariance = Eigen::Vector3d(0.01, 0.01, 1e-8).asDiagonal();
    recording.events.emplace_back(moved);
    recording.events.emplace_back(core::Scan{moved.t_ns, {}, {}, {}});
    const double t_s = 0.5 * k - 0.2;
    recording.true_positions.push_back({core::nanoseconds_from_seconds(t_s), {10.0 * t_s, 0.0}, 0.05});
  }
  fuse_gps(recording, {true, 0.05, 30.0});
  supervisor::Navigator navigator(recording.start);
  for (const core::Event& event : recording.events) {
    navigator.take(event);
    if (std::holds_alternative<core::Odometry>(event)) continue;  // used with what comes next
    const double x_m = 10.0 * core::seconds(core::time_of(event));
    EXPECT_NEAR(navigator.pose().mean.x_m, x_m, 1e-6);
  }
}

}  // namespace
}  // namespace helixnav::apps
