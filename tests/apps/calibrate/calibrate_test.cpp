// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/random.hpp"
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

TEST_F(CalibrateProgram, RefusesBearingsThatAreCountedClockwise) {
  std::istringstream rows(text_of(log_ / "detections.csv"));
  std::string row, clockwise;
  std::getline(rows, row);
  clockwise = row + '\n';
  while (std::getline(rows, row)) {
    const std::size_t bearing = row.rfind(',') + 1;
    if (bearing < row.size()) row = row[bearing] == '-' ? row.erase(bearing, 1) : row.insert(bearing, "-");
    clockwise += row + '\n';
  }
  folder_.write("robot/detections.csv", clockwise);
  const Outcome refused = run({"calibrate", log_, "--out", out_});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("are bearings or turns counted clockwise?"), std::string::npos) << refused.err;
  EXPECT_FALSE(fs::exists(out_));
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

/// The first 200 s of a log, with all bearings scaled.
void stretch_bearings_and_cut(const fs::path& log, double stretch) {
  const std::string odometry = text_of(log / "odometry.csv"), seen = text_of(log / "detections.csv");
  constexpr double last_s = 200.0;
  const auto write = [&](const char* file, const std::string& text, bool is_seen) {
    std::istringstream lines(text);
    std::ofstream out(log / file);
    std::string line;
    std::getline(lines, line);
    out << line << '\n';
    while (std::getline(lines, line) && std::stod(line) < last_s) {
      const std::size_t comma = line.rfind(',');
      const bool has_bearing = is_seen && comma + 1 < line.size();
      out << (has_bearing ? line.substr(0, comma + 1) + std::to_string(stretch * std::stod(line.substr(comma + 1)))
                          : line)
          << '\n';
    }
  };
  write("odometry.csv", odometry, false);
  write("detections.csv", seen, true);
}

TEST_F(CalibrateProgram, WritesNothingThatHasNotSettledAndUsesLittle) {
  stretch_bearings_and_cut(log_, 1.8);
  const Outcome outcome = run({"calibrate", log_, "--out", out_});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.out;
  EXPECT_NE(outcome.out.find("not settled"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("not written, since nothing settled"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(out_));
}

/// It settles, at a lever arm of 8 m that is not given.
TEST_F(CalibrateProgram, WritesNothingThatNoVehicleFileHas) {
  stretch_bearings_and_cut(log_, 1.5);
  std::string vehicle = text_of(log_ / "vehicle.toml");
  const std::size_t arm = vehicle.find("\nx_m = 0.5");
  ASSERT_NE(arm, std::string::npos);
  std::ofstream(log_ / "vehicle.toml") << vehicle.replace(arm, 10, "\nx_m = 0.0");
  const Outcome outcome = run({"calibrate", log_, "--out", out_});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.out;
  EXPECT_NE(outcome.err.find("not written, since x_m"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(out_));
}

TEST_F(CalibrateProgram, WritesNothingWhenInterrupted) {
  Program program({"calibrate", log_, "--out", out_});
  constexpr int patience_ms = 30'000;
  for (int ms = 0; ms < patience_ms && !program.catches(SIGINT); ++ms) ::usleep(1000);
  program.send(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("nothing is written"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(out_));
}

/// Straight on past poles at a steady speed.
void write_straight_drive(const fs::path& folder) {
  core::RandomStream random(1, "straight drive");
  fs::create_directories(folder);
  std::ofstream vehicle(folder / "vehicle.toml"), odometry(folder / "odometry.csv"), seen(folder / "detections.csv");
  vehicle << "[odometry]\nsigma_along_m_per_sqrt_m = 0.02\nsigma_sideways_m_per_sqrt_m = 0.002\n"
             "sigma_heading_deg_per_sqrt_m = 0.1\n[[sensor]]\nreach_m = 12\nsigma_range_m = 0.05\nsigma_bearing_deg = "
             "0.3\n";
  odometry << "t_s,dx_m,dy_m,dheading_deg\n0,0,0,0\n";
  seen << "t_s,range_m,bearing_deg\n";
  for (int k = 1; k <= 240; ++k) {
    const double t_s = 0.25 * k, x_m = t_s;
    odometry << t_s << ',' << 0.25 + 0.01 * random.normal() << ',' << 0.001 * random.normal() << ','
             << 0.05 * random.normal() << '\n';
    for (int pole = 0; pole < 20; ++pole) {
      const Eigen::Vector2d to(4.0 * pole - x_m, pole % 2 == 0 ? 4.0 : -5.0);
      if (to.norm() > 12.0) continue;
      seen << t_s << ',' << to.norm() + 0.05 * random.normal() << ','
           << std::atan2(to.y(), to.x()) * 180.0 / core::pi + 0.3 * random.normal() << '\n';
    }
  }
}

// The position of a sensor and a scale of turns are visible only in turns.
TEST(CalibrateStraightDrive, SaysWhatCannotBeObserved) {
  const testing::TemporaryFolder folder;
  const fs::path log = folder.path() / "log", out = folder.path() / "out.toml";
  write_straight_drive(log);
  const Outcome outcome = run({"calibrate", log, "--out", out});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* key : {"x_m", "y_m", "turn_scale", "delay_s"}) {
    const std::regex row(std::string(key) + R"( +given .* not observable from this log: left as given)");
    EXPECT_TRUE(std::regex_search(outcome.out, row)) << key << '\n' << outcome.out;
  }
  EXPECT_TRUE(std::regex_search(outcome.out, std::regex("heading_deg +given .* observable"))) << outcome.out;
  EXPECT_EQ(logs::read_vehicle(out).sensors.at(0).T_vehicle_sensor.x_m, 0.0);
}

class CalibrateRealLog : public testing::RealDataTest {
 protected:
  testing::TemporaryFolder folder_;
};

// The file written can be calibrated again and stays. The range scale is given: estimated, it moves with the noise.
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
