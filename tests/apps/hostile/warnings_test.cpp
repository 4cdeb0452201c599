// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "program.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

const char* const vehicle =
    "[odometry]\nsigma_along_m_per_sqrt_m = 0.05\nsigma_sideways_m_per_sqrt_m = 0.02\nsigma_heading_deg_per_sqrt_m = "
    "0.3\n"
    "[[sensor]]\nreach_m = 30\nsigma_range_m = 0.1\nsigma_bearing_deg = 0.5\n";

class Warnings : public ::testing::Test {
 protected:
  /// A drive straight past 200 poles on either side, with error-free odometry and detections.
  void SetUp() override {
    std::string odometry = "t,v,omega\n", detections = "t,x_m,y_m,sigma_x,sigma_y\n";
    for (int t = 0; t <= 100; ++t) {
      odometry += std::to_string(t) + ",2,0\n";
      for (int pole = 0; pole < 40; ++pole) {
        const double x_m = 6.0 * pole - 2.0 * t, y_m = (pole % 2 == 0 ? 1.0 : -1.0) * (4.0 + pole % 5);
        if (std::abs(x_m) > 25.0) continue;
        detections += std::to_string(t) + "," + std::to_string(x_m) + "," + std::to_string(y_m) + ",0.1,0.1\n";
      }
    }
    folder_.write("log/vehicle.toml", vehicle);
    folder_.write("log/odometry.csv", odometry);
    folder_.write("log/detections.csv", detections);
  }
  Outcome replay(const Words& more = {}) const {
    Words words{"replay", log_, "--out", folder_.path() / "run", "--overwrite", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  void expect(const Outcome& outcome, int exit_code, const std::string& said) const {
    EXPECT_EQ(outcome.exit_code, exit_code);
    EXPECT_NE(outcome.err.find(said), std::string::npos) << "no \"" << said << "\" in: " << outcome.err;
    EXPECT_EQ(outcome.out.find("nan"), std::string::npos) << outcome.out;
  }

  testing::TemporaryFolder folder_;
  const fs::path log_ = folder_.path() / "log";
};

TEST_F(Warnings, TellThatTheLogIsBetterThanAssumed) {
  expect(replay(), 0, "times smaller than the assumed noise");  // it has no error at all
}

/// An empty column of identities says no more than no column.
TEST_F(Warnings, AreNotNeededWhereNoDetectionHasAnIdentity) {
  std::string detections = "t,range_m,bearing_deg,id\n";
  for (int t = 0; t < 100; ++t) detections += std::to_string(t) + ",5,3,\n";
  folder_.write("log/detections.csv", detections);
  expect(replay({"--association", "known"}), 3, "--association known needs a labelled log, and this one has no labels");
  expect(replay({"--filter", "fastslam", "--fastslam.association", "known"}), 3,
         "--fastslam.association known needs a labelled log, and this one has no labels");
  folder_.write("log/detections.csv", detections + "99.5,5,3,oak\n");
  EXPECT_EQ(replay({"--association", "known"}).exit_code, 0) << "one is enough to go by";
}

TEST_F(Warnings, TellOfAMapWithoutALandmark) {
  std::string detections = "t,range_m,bearing_deg\n";
  for (int t = 0; t < 100; ++t)
    detections +=
        std::to_string(t) + "," + std::to_string(3 + 7 * t % 23) + "," + std::to_string((47 * t) % 360) + "\n";
  folder_.write("log/detections.csv", detections);
  expect(replay(), 0, "the map has no landmark: of 100 detections");
}

TEST_F(Warnings, TellOfTruthOfAnotherClock) {
  folder_.write("log/truth_poses.csv", "t,x,y\n5000,0,0\n5001,1,0\n");
  const Outcome outcome = replay();
  expect(outcome, 0, "none of the 2 true positions is within the time span of the run");
  EXPECT_NE(outcome.out.find("position error       unknown"), std::string::npos) << outcome.out;
}

TEST_F(Warnings, RefuseRangesWithoutIdentitiesAndSayWhatToDo) {
  folder_.write("log/detections.csv", "t,range_m\n1,10\n2,10\n");
  expect(replay(), 3, "the log has none (a column id)");
  folder_.write("log/detections.csv", "t,range_m,id\n1,10,a\n2,10,a\n");
  expect(replay(), 3, "add --association known");
  expect(run({"calibrate", log_}), 3, "add --association known");
}

TEST_F(Warnings, RefuseToSmoothOrKnowWhatHasNoLabels) {
  const Outcome smooth = run({"smooth", log_, "--out", folder_.path() / "smooth"});
  expect(smooth, 3, "smooth needs a labelled log or a graph");
  expect(replay({"--association", "known"}), 3, "--association known needs a labelled log");
}

TEST_F(Warnings, ProposeKeysOfTheSectionThatWasMeant) {
  const fs::path config = folder_.write("mine.toml", "[landmarks]\nmature_look = 4\n");
  const Outcome outcome = replay({"--config", config});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_NE(outcome.err.find("the nearest is 'landmarks."), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace helixnav::apps
