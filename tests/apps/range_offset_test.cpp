// SPDX-License-Identifier: BSD-3-Clause
#include "drive/range_offset.hpp"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "calibrate/spoilt_log.hpp"
#include "helixnav/core/observation.hpp"
#include "helixnav/core/random.hpp"
#include "program.hpp"

namespace helixnav::apps {
namespace {

struct Passage {
  core::Recording recording;
  runs::Run run;
};

/// A drive straight past 12 poles with ranges short by `offset_m` and noise of so many standard deviations; the run knows
/// the poses, and the poles moved by `off_m` alternately.
Passage passage(double offset_m, double noise, double off_m = 0.0) {
  core::RandomStream random(1, "range offset test");
  Passage made;
  for (int i = 0; i < 12; ++i) {
    core::MapLandmark pole;
    pole.id = i;
    pole.state = core::LandmarkState::mature;
    pole.point.mean_m = {4.0 * i, (i % 2 == 0 ? 1.0 : -1.0) * (3.0 + i % 3)};
    made.run.map.push_back(pole);
  }
  for (int k = 0; k < 50; ++k) {
    const core::Pose2 pose(1.0 * k, 0.0, 0.0);
    core::Scan scan;
    core::StepReport step;
    step.pose.mean = core::Pose2(pose.x_m, (k % 2 == 0 ? 1.0 : -1.0) * off_m, 0.0);
    for (const core::MapLandmark& pole : made.run.map) {
      core::Observation seen;
      seen.kind = core::ObservationKind::range_bearing;
      seen.z = core::predict_observation(seen.kind, pose, core::Pose2(), pole.point.mean_m).z_hat;
      if (seen.z[0] > 12.0) continue;
      seen.z[0] += noise * random.normal(0.0, 0.05) - offset_m;
      seen.z[1] += noise * random.normal(0.0, 0.01);
      seen.R = core::ObsMatrix::Zero(2, 2);
      seen.R(0, 0) = 0.05 * 0.05;
      seen.R(1, 1) = 0.01 * 0.01;
      core::AssociationReport pair;
      pair.observation = static_cast<int>(scan.observations.size());
      pair.outcome = core::Outcome::matched;
      pair.landmark = pole.id;
      step.associations.push_back(pair);
      scan.observations.push_back(seen);
    }
    made.recording.events.emplace_back(scan);
    made.run.steps.push_back(step);
  }
  return made;
}

TEST(RangeOffset, IsFoundExactlyWithoutNoise) {
  const Passage made = passage(0.1, 0.0);
  const auto found = range_offset_of(made.recording, made.run);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->offset_m, 0.1, 1e-9);
}

TEST(RangeOffset, IsNotMadeByPosesThatAreOff) {
  const Passage made = passage(0.1, 0.0, 0.03);
  const auto found = range_offset_of(made.recording, made.run);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->offset_m, 0.1, 0.01);
}

TEST(RangeOffset, IsWithinItsStandardDeviations) {
  const Passage made = passage(0.05, 1.0);
  const auto found = range_offset_of(made.recording, made.run);
  ASSERT_TRUE(found);
  EXPECT_LT(found->sigma_m, 0.015);
  EXPECT_NEAR(found->offset_m, 0.05, 3.0 * found->sigma_m);
}

TEST(RangeOffset, IsNotAskedOfARunWithoutMatches) { EXPECT_FALSE(range_offset_of(core::Recording(), runs::Run())); }

/// Adds the stated offset to the vehicle file of a spoilt log, beside whatever else in it is right.
void tell_offset(const SpoiltLog& log, const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  std::ofstream(file) << text.str() << "range_offset_m = " << log.right.at("range_offset_m") << "\n";
}

TEST(RangeOffset, IsSaidOfADriveThatWasToldOfNone) {
  const testing::TemporaryFolder folder;
  const SpoiltLog log = write_spoilt_log(201, folder.path() / "log");
  const Outcome short_ranges = run({"replay", folder.path() / "log", "--out", folder.path() / "short", "--quiet"});
  EXPECT_NE(short_ranges.err.find("ranges seem to be too short by at least 0."), std::string::npos) << short_ranges.err;
  tell_offset(log, folder.path() / "log/vehicle.toml");
  const Outcome told = run({"replay", folder.path() / "log", "--out", folder.path() / "told", "--quiet"});
  EXPECT_EQ(told.err.find("ranges seem"), std::string::npos) << told.err;
}

}  // namespace
}  // namespace helixnav::apps
