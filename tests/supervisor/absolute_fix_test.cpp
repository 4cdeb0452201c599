// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "campaign.hpp"
#include "circuits.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/supervisor/named_navigator.hpp"

namespace helixnav::supervisor {
namespace {

/// Dead reckoning with a fix after every fourth scan; every fifth fix is 30 m off when `outliers`.
struct FixedRun {
  double last_nees = 0.0;
  double worst_error_m = 0.0;
  int accepted = 0;
  int refused = 0;
};

FixedRun fixed_run(std::uint64_t seed, bool fixes, bool outliers) {
  const core::Recording run = sim::simulate(wide_circuit(), seed);
  core::RandomStream noise(seed + 1000);
  NamedNavigator navigator(run.start);
  FixedRun result;
  drive(run, navigator, [&](const core::Scan& scan, std::size_t i) {
    const core::Pose2& truth = run.true_poses[i].T_world_robot;
    if (fixes && i % 4 == 3) {
      core::AbsoluteFix fix;
      fix.t_ns = scan.t_ns;
      fix.antenna_robot_m = {1.5, 0.4};
      fix.covariance_m2 = 0.25 * Eigen::Matrix2d::Identity();
      fix.position_world_m =
          core::transform(truth, fix.antenna_robot_m) + 0.5 * Eigen::Vector2d(noise.normal(), noise.normal());
      if (outliers && i % 20 == 19) fix.position_world_m += Eigen::Vector2d(30.0, 0.0);
      navigator.fix(fix);
    }
    core::Scan nothing = scan;
    nothing.observations.clear();
    const core::StepReport report = navigator.observe(nothing, {});
    for (const core::Decision& decision : report.decisions) {
      ++(std::get<core::FixDecision>(decision).accepted ? result.accepted : result.refused);
    }
    result.worst_error_m = std::max(result.worst_error_m, (report.pose.mean.position_m() - truth.position_m()).norm());
    result.last_nees = nees(report.pose, truth);
  });
  return result;
}

TEST(AbsoluteFix, KeepsTheErrorBoundedWhereDeadReckoningDrifts) {
  double with = 0.0;
  double without = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    with = std::max(with, fixed_run(seed, true, false).worst_error_m);
    without = std::max(without, fixed_run(seed, false, false).worst_error_m);
  }
  EXPECT_LT(with, 2.5);
  EXPECT_GT(without, 5.0);
}

// 100 independent runs: the sum of their NEES is within the two-sided band with probability 0.998.
TEST(AbsoluteFixCampaign, LeavesThePoseConsistent) {
  double sum = 0.0;
  for (const std::uint64_t seed : support::campaign_seeds(1, 100)) sum += fixed_run(seed, true, false).last_nees;
  const support::Band band = support::chi2_band(support::campaign_runs(100), 3, 0.002);
  EXPECT_GT(sum, band.low);
  EXPECT_LT(sum, band.high);
}

TEST(AbsoluteFix, IsRefusedWithItsNumbersWhenItIsAnOutlier) {
  int accepted = 0;
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const FixedRun run = fixed_run(seed, true, true);
    accepted += run.accepted;
    refused += run.refused;
    EXPECT_LT(run.worst_error_m, 3.0);
  }
  // One in five is an outlier, and all of these are refused; of the others, one in a thousand.
  EXPECT_GE(refused * 5, (accepted + refused) * 99 / 100);
  EXPECT_LE(refused * 5, (accepted + refused) * 103 / 100);
}

}  // namespace
}  // namespace helixnav::supervisor
