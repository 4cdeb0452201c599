// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <regex>
#include <string>

#include <gtest/gtest.h>

#include "helixnav/logs/vehicle.hpp"
#include "program.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

class CalibrateProgram : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(run({"new-vehicle", log_}).exit_code, 0); }

  testing::TemporaryFolder folder_;
  const fs::path log_ = folder_.path() / "robot";
  const fs::path out_ = folder_.path() / "calibrated.toml";
};

TEST_F(CalibrateProgram, UndoesWhatIsToldWrongOfTheNoise) {
  const Outcome right = run({"calibrate", log_, "--out", out_});
  ASSERT_EQ(right.exit_code, 0) << right.err;
  const logs::Vehicle found = logs::read_vehicle(out_);
  const std::string text = text_of(log_ / "vehicle.toml");
  const auto write = [&](const std::string& section, const std::string& scale, const std::string& from) {
    std::string changed = from;
    changed.insert(changed.find(section) + section.size(), "\nnoise_scale = " + scale + "\n");
    return changed;
  };
  folder_.write("robot/vehicle.toml", write("[[sensor]]", "0.6", write("[odometry]", "1.7", text)));
  const fs::path again = folder_.path() / "again.toml";
  const Outcome wrong = run({"calibrate", log_, "--out", again});
  ASSERT_EQ(wrong.exit_code, 0) << wrong.err;
  const logs::Vehicle refound = logs::read_vehicle(again);
  EXPECT_NEAR(refound.odometry.noise_scale / found.odometry.noise_scale, 1.0, 0.05);
  EXPECT_NEAR(refound.sensors.at(0).noise_scale / found.sensors.at(0).noise_scale, 1.0, 0.05);
  EXPECT_NE(text_of(again).find("# a vehicle"), 0u);
  EXPECT_NE(text_of(again).find("the origin of the frame"), std::string::npos) << "comments stay";
}

TEST_F(CalibrateProgram, RefusesWhatItCannotUse) {
  folder_.write("taken.toml", "");
  EXPECT_EQ(run({"calibrate", log_, "--out", folder_.path() / "taken.toml"}).exit_code, 3);
  fs::remove(log_ / "vehicle.toml");
  const Outcome none = run({"calibrate", log_});
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_NE(none.err.find("begins with a vehicle.toml"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace helixnav::apps
