// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/logs/vehicle.hpp"
#include "program.hpp"
#include "real_data.hpp"

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

TEST_F(CalibrateProgram, SaysWhatIsMissingOrWrong) {
  const Outcome no_log = run({"calibrate", folder_.path() / "nothing"});
  EXPECT_EQ(no_log.exit_code, 3);
  EXPECT_NE(no_log.err.find("found nothing there"), std::string::npos) << no_log.err;
  const Outcome no_option = run({"calibrate", log_, "--vehicel", "x"});
  EXPECT_EQ(no_option.exit_code, 2);
  EXPECT_NE(no_option.err.find("did you mean '--vehicle'"), std::string::npos) << no_option.err;
  const Outcome noise_beside = run({"calibrate", log_, "--log.covariance_scale", "2"});
  EXPECT_EQ(noise_beside.exit_code, 2);
  EXPECT_NE(noise_beside.err.find("calibrate judges the vehicle file"), std::string::npos) << noise_beside.err;
}

class CalibrateRealLog : public testing::RealDataTest {
 protected:
  testing::TemporaryFolder folder_;
};

// What is written can be calibrated again, and stays. The scale of the ranges is given: estimated, it moves with the noise.
TEST_F(CalibrateRealLog, BeginsWithTheVehicleThatShipsAndWritesOneThatHolds) {
  find_real_data("plaza");
  if (IsSkipped()) return;
  const fs::path out = folder_.path() / "robot.toml";
  const auto words = [this](const std::string& vehicle, const std::string& to) {
    return std::vector<std::string>{"calibrate", path_,       "--association", "known", "--plaza.range_scale",
                                    "1.07",      "--vehicle", vehicle,         "--out", to};
  };
  const Outcome outcome = run(words("plaza", out));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const logs::Vehicle found = logs::read_vehicle(out);
  EXPECT_GT(found.odometry.noise_scale, 1.5);
  EXPECT_NEAR(found.sensors.at(0).noise_scale, 0.84, 0.05);
  EXPECT_EQ(found.sensors.at(0).sigma_range_m, 0.6) << "as it was: the factor stands beside it";
  const fs::path again = folder_.path() / "again.toml";
  ASSERT_EQ(run(words(out, again)).exit_code, 0);
  const logs::Vehicle refound = logs::read_vehicle(again);
  EXPECT_NEAR(refound.odometry.noise_scale / found.odometry.noise_scale, 1.0, 0.05);
  EXPECT_NEAR(refound.sensors.at(0).noise_scale / found.sensors.at(0).noise_scale, 1.0, 0.05);
}

}  // namespace
}  // namespace helixnav::apps
