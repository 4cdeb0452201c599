// SPDX-License-Identifier: BSD-3-Clause
// What a session that continued in an earlier map and was then carried leaves in its folder.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "helixnav/core/random.hpp"
#include "helixnav/core/se2.hpp"
#include "program.hpp"
#include "temporary_folder.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

constexpr double bend_m = 20.0;  ///< radius of each circle driven

std::vector<Eigen::Vector2d> trees_of(std::uint64_t world) {
  core::RandomStream random(world, "wood");
  std::vector<Eigen::Vector2d> trees_m;
  for (int i = 0; i < 50; ++i) {
    const double x_m = random.uniform(-32.0, 32.0);
    trees_m.emplace_back(x_m, random.uniform(-32.0, 32.0));
  }
  return trees_m;
}

/// Appends a drive round a circle through the wood to tables of odometry and detections.
void add_drive(std::uint64_t world, int first_step, int steps, std::string& odometry, std::string& detections) {
  core::RandomStream random(world + static_cast<std::uint64_t>(first_step), "noise");
  const std::vector<Eigen::Vector2d> trees_m = trees_of(world);
  char row[120];
  for (int k = 0; k < steps; ++k) {
    const double angle_rad = 0.5 * k / bend_m;
    const core::Pose2 here(bend_m * std::cos(angle_rad), bend_m * std::sin(angle_rad), angle_rad + 1.5707963);
    const double t_s = 0.5 * (first_step + k), moved = k == 0 ? 0.0 : 1.0;
    const double dx_m = moved * (0.5 + random.normal(0.0, 0.01)),
                 turn_rad = moved * (0.025 + random.normal(0.0, 0.002));
    std::snprintf(row, sizeof row, "%.3f,%.6f,%.6f,%.6f\n", t_s, dx_m, 0.0, turn_rad);
    odometry += row;
    for (const Eigen::Vector2d& tree_m : trees_m) {
      const Eigen::Vector2d seen_m = core::transform(core::inverse(here), tree_m);
      if (seen_m.norm() > 15.0) continue;
      const double range_m = seen_m.norm() + random.normal(0.0, 0.05);
      const double bearing_rad = std::atan2(seen_m.y(), seen_m.x()) + random.normal(0.0, 0.005);
      std::snprintf(row, sizeof row, "%.3f,%.6f,%.6f\n", t_s, range_m, bearing_rad);
      detections += row;
    }
  }
}

class CarriedOnMap : public ::testing::Test {
 protected:
  fs::path in(const std::string& name) const { return folder_.path() / name; }

  /// A log of drives through these woods, one after another; the vehicle is carried between them.
  void write_log(const std::string& name, const std::vector<std::uint64_t>& worlds, int first_step) const {
    std::string odometry = "t_s,dx_m,dy_m,dheading_rad\n", detections = "t_s,range_m,bearing_rad\n", lost = "t_s\n";
    constexpr int steps = 250;
    for (std::size_t i = 0; i < worlds.size(); ++i) {
      const int first = first_step + static_cast<int>(i) * steps;
      if (i > 0) lost += std::to_string(0.5 * first - 0.25) + '\n';
      add_drive(worlds[i], first, steps, odometry, detections);
    }
    fs::create_directories(in(name));
    write(name + "/odometry.csv", odometry);
    write(name + "/detections.csv", detections);
    if (worlds.size() > 1) write(name + "/lost.csv", lost);
    write(name + "/vehicle.toml",
          "[odometry]\nsigma_along_m_per_sqrt_m = 0.015\nsigma_sideways_m_per_sqrt_m = 0.005\n"
          "sigma_heading_deg_per_sqrt_m = 0.17\n[[sensor]]\nreach_m = 15.0\nview_deg = [-180, 180]\n"
          "sigma_range_m = 0.05\nsigma_bearing_deg = 0.3\n");
  }

  void must_replay(const std::string& log, const std::string& map, const std::string& out) const {
    std::vector<std::string> words{"replay", in(log), "--quiet", "--out", in(out)};
    if (!map.empty()) words.insert(words.end(), {"--map", in(map)});
    const Outcome outcome = run(words);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }

  bool is_placed(const std::string& name) const {
    return nlohmann::json::parse(text_of(in(name) / "summary.json")).at("placed").at("found");
  }

 private:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(in(name), std::ios::binary) << text;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(CarriedOnMap, TheEarlierMapThatWasGoneOnInIsKeptAsAPart) {
  write_log("monday", {1}, 0);
  write_log("tuesday", {1, 2}, 1000);
  write_log("wednesday", {1}, 3000);
  must_replay("monday", "", "run_monday");
  must_replay("tuesday", "run_monday", "run_tuesday");
  ASSERT_TRUE(fs::exists(in("run_tuesday") / "part_0" / "map.bin"));
  must_replay("wednesday", "run_tuesday/part_0", "run_wednesday");
  EXPECT_TRUE(is_placed("run_wednesday"));
  const Outcome twice = run({"join", in("run_monday"), in("run_tuesday/part_0"), "--out", in("twice")});
  EXPECT_EQ(twice.exit_code, 3) << "both hold Monday's drive";
}

TEST_F(CarriedOnMap, AnEarlierMapOnWhichItNeverWasIsNotCopied) {
  write_log("monday", {1}, 0);
  write_log("elsewhere", {2, 3}, 1000);
  must_replay("monday", "", "run_monday");
  must_replay("elsewhere", "run_monday", "run_elsewhere");
  EXPECT_FALSE(fs::exists(in("run_elsewhere") / "part_0"));
  EXPECT_TRUE(fs::exists(in("run_elsewhere") / "part_1" / "map.bin"));
}

}  // namespace
}  // namespace helixnav::apps
