// SPDX-License-Identifier: BSD-3-Clause
#include "drive/systematic_motion.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "calibrate/spoilt_log.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/core/random.hpp"
#include "program.hpp"

namespace helixnav::apps {
namespace {

struct Wrong {
  double scale = 0.0, aside_rad = 0.0;
  int jumps = 0;  ///< corrections of 3 m, as from a closing
};

struct Drive400 {
  core::Recording recording;
  runs::Run run;
};

/// 400 scans with a match, a metre apart and every fourth one backwards; the odometry errs as given, plus noise of which
/// the filter takes back half in each scan.
Drive400 drive400(const Wrong& wrong, std::uint64_t seed) {
  core::RandomStream random(seed, "systematic motion test");
  Drive400 made;
  core::Pose2 pose;
  for (int k = 0; k <= 400; ++k) {
    if (k > 0) {
      const double way_m = k % 4 == 0 ? -1.0 : 1.0;
      core::Odometry odometry = core::no_motion(k);
      odometry.T_before_after = core::Pose2((1.0 + wrong.scale) * way_m, 0.0, 0.02);
      made.recording.events.emplace_back(odometry);
      double along_m = way_m * std::cos(wrong.aside_rad) + random.normal(0.0, 0.02);
      const double across_m = way_m * std::sin(wrong.aside_rad) + random.normal(0.0, 0.02);
      if (wrong.jumps > 0 && k % (400 / wrong.jumps) == 7) along_m += 3.0;
      pose = core::compose(pose, core::Pose2(along_m, across_m, 0.02));
    }
    core::Scan scan;
    scan.t_ns = k;
    made.recording.events.emplace_back(scan);
    core::StepReport step;
    step.pose.mean = pose;
    core::AssociationReport match;
    match.outcome = core::Outcome::matched;
    step.associations.push_back(match);
    made.run.steps.push_back(step);
  }
  return made;
}

/// Mean of squared z over 60 seeds: 60 times that is χ² of 60, outside by chance in 1.4 % of such tests.
void expect_standard(double sum_z2) {
  constexpr int seeds = 60;
  EXPECT_GT(sum_z2 / seeds, 0.60);
  EXPECT_LT(sum_z2 / seeds, 1.50);
}

TEST(SystematicMotion, IsNoughtWithinItsSigmasWhereNothingIsWrong) {
  double along_z2 = 0.0, across_z2 = 0.0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Drive400 made = drive400({}, seed);
    const auto found = systematic_motion_of(made.recording, made.run);
    ASSERT_TRUE(found);
    along_z2 += std::pow(found->too_long / found->too_long_sigma, 2);
    across_z2 += std::pow(found->sideways_rad / found->sideways_sigma_rad, 2);
  }
  expect_standard(along_z2);
  expect_standard(across_z2);
}

TEST(SystematicMotion, FindsScaleAndSensorThatLooksAside) {
  const Drive400 made = drive400({0.03, -0.02}, 1);
  const auto found = systematic_motion_of(made.recording, made.run);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->too_long, 0.03, 4.0 * found->too_long_sigma);
  EXPECT_NEAR(found->sideways_rad, -0.02, 4.0 * found->sideways_sigma_rad);
  EXPECT_LT(found->too_long_sigma, 0.002);
}

TEST(SystematicMotion, FindsNoScaleByBearings) {
  Drive400 made = drive400({0.03, -0.02}, 1);
  for (core::Event& event : made.recording.events) {
    if (auto* scan = std::get_if<core::Scan>(&event)) scan->observations = {core::make_bearing(0.1, 0.01)};
  }
  const auto found = systematic_motion_of(made.recording, made.run);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->too_long, 0.0);
  EXPECT_NEAR(found->sideways_rad, -0.02, 4.0 * found->sideways_sigma_rad);
}

TEST(SystematicMotion, ForgetsJumps) {
  const Drive400 made = drive400({0.0, 0.0, 8}, 1);
  const auto found = systematic_motion_of(made.recording, made.run);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->too_long, 0.0, 4.0 * found->too_long_sigma);
}

TEST(SystematicMotion, IsNotAskedOfAShortRun) { EXPECT_FALSE(systematic_motion_of(core::Recording(), runs::Run())); }

TEST(SystematicMotion, IsSaidOfASpoiltLogAndNotOfTheExample) {
  const testing::TemporaryFolder folder;
  const SpoiltLog log = write_spoilt_log(207, folder.path() / "log");
  const Outcome spoilt = run(
      {"replay", folder.path() / "log", "--out", folder.path() / "spoilt", "--quiet", "--noise.systematic", "false"});
  const std::string side =
      log.right.at("heading_deg") > 0.0 ? "to the right of its odometry" : "to the left of its odometry";
  EXPECT_NE(spoilt.err.find(side), std::string::npos) << spoilt.err;
  ASSERT_EQ(run({"new-vehicle", folder.path() / "example"}).exit_code, 0);
  const Outcome example = run({"replay", folder.path() / "example", "--out", folder.path() / "right", "--quiet"});
  EXPECT_EQ(example.err.find("judging by the detections"), std::string::npos) << example.err;
}

}  // namespace
}  // namespace helixnav::apps
