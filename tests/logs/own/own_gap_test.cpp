// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <optional>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "helixnav/core/odometry.hpp"
#include "own_log_folder.hpp"

namespace helixnav::logs {
namespace {

constexpr double turn_radps = 0.4;

/// 50 s at 1 m/s with turns of five seconds each; then no rows for `gap_s`. Scans at its start and end, and the given number between.
core::Odometry way_through(double gap_s, int scans_between) {
  const OwnLogFolder log;
  log.write("vehicle.toml",
            "[odometry]\nsigma_v_mps = 0.01\nsigma_omega_deg_per_s = 0.1\n"
            "[[sensor]]\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n");
  std::string rows = "t,v,omega\n", scans = "t,range_m,bearing_deg\n50,10,1\n";
  for (int i = 0; i <= 500; ++i) {
    rows += std::to_string(0.1 * i) + ",1," + std::to_string((i / 50) % 2 == 0 ? 0.0 : turn_radps) + "\n";
  }
  rows += std::to_string(50.0 + gap_s) + ",1,0\n";
  for (int i = 1; i <= scans_between + 1; ++i) {
    scans += std::to_string(50.0 + gap_s * i / (scans_between + 1)) + ",10,1\n";
  }
  log.write("odometry.csv", rows);
  log.write("detections.csv", scans);
  std::optional<core::Odometry> way;
  for (const core::Event& event : log.recording().events) {
    const auto* part = std::get_if<core::Odometry>(&event);
    if (part != nullptr && part->t_ns > 50'000'000'000) way = way ? core::chain(*way, *part) : *part;
  }
  return way.value_or(core::no_motion(0));
}

// If it is held as certain, a vehicle that turned meanwhile is misplaced: by 8 m in one of eight simulated logs.
TEST(OwnGap, LeavesOpenThatTheVehicleTurnsAsItDidBefore) {
  const double q = turn_radps * turn_radps / 5.0;
  for (const double gap_s : {3.0, 6.0}) {
    const core::Odometry way = way_through(gap_s, 0);
    EXPECT_NEAR(way.T_before_after.x_m, gap_s, 1e-9) << "it is held";
    EXPECT_NEAR(std::sqrt(way.covariance(2, 2)), std::sqrt(q * gap_s * gap_s * gap_s / 3.0), 0.2 * gap_s / 3.0);
    EXPECT_GT(std::sqrt(way.covariance(1, 1)), 0.7 * std::sqrt(q * std::pow(gap_s, 5.0) / 20.0));
    EXPECT_LT(std::sqrt(way.covariance(1, 1)), 1.2 * std::sqrt(q * std::pow(gap_s, 5.0) / 20.0));
  }
}

TEST(OwnGap, IsAsUncertainHoweverOftenScansDivideIt) {
  const Eigen::Matrix3d once = way_through(5.0, 0).covariance, often = way_through(5.0, 24).covariance;
  EXPECT_LT((once - often).norm(), 0.02 * once.norm());
}

/// The chain of the gap's pieces has variances of 10²³ m²; no event may have those.
TEST(OwnGap, OfDaysIsStillAnEventThatCanBeTaken) {
  const Eigen::Matrix3d covariance = way_through(1e6, 0).covariance;
  EXPECT_LT(covariance.cwiseAbs().maxCoeff(), 1.01e15);
  EXPECT_GT(covariance(0, 0), 1e7);
}

TEST(OwnGap, IsNoneWhereRowsAreAsFarApartAsEver) { EXPECT_LT(std::sqrt(way_through(0.9, 0).covariance(2, 2)), 0.01); }

}  // namespace
}  // namespace helixnav::logs
