// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/se2.hpp"
#include "own_log_folder.hpp"

namespace helixnav::logs {
namespace {

/// +1: as the log is meant; -1: counted clockwise.
struct Signs {
  double bearings = 1.0;
  double turns = 1.0;
};

/// Two rounds of 20 m diameter at 2 m/s among 40 posts, a scan a second up to 15 m; all noise is within the vehicle file's.
std::string remarks_on_rounds(const Signs& signs, double turn_rad_per_s = 0.2) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place_m(-20.0, 20.0);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<Eigen::Vector2d> posts_m;
  for (int i = 0; i < 40; ++i) {
    const double x_m = place_m(random);  // in this order, whatever the compiler
    posts_m.emplace_back(x_m, place_m(random));
  }
  std::string odometry = "t_s,v_mps,omega_radps\n", detections = "t_s,range_m,bearing_rad\n";
  core::Pose2 pose;
  for (int i = 0; i < 63; ++i) {
    odometry += std::to_string(i) + ",2," + std::to_string(signs.turns * turn_rad_per_s) + '\n';
    for (const Eigen::Vector2d& post_m : posts_m) {
      const Eigen::Vector2d seen_m = core::transform(core::inverse(pose), post_m);
      if (seen_m.norm() > 15.0) continue;
      const double bearing_rad = std::atan2(seen_m.y(), seen_m.x()) + 0.003 * noise(random);
      detections += std::to_string(i) + ',' + std::to_string(seen_m.norm() + 0.05 * noise(random)) + ',' +
                    std::to_string(signs.bearings * bearing_rad) + '\n';
    }
    const double arc_rad = turn_rad_per_s;
    const core::Pose2 moved = arc_rad == 0.0 ? core::Pose2(2.0, 0.0, 0.0)
                                             : core::Pose2(2.0 * std::sin(arc_rad) / arc_rad,
                                                           2.0 * (1.0 - std::cos(arc_rad)) / arc_rad, arc_rad);
    pose = core::compose(pose, moved);
  }
  const OwnLogFolder log;
  log.write("odometry.csv", odometry);
  log.write("detections.csv", detections);
  log.write("vehicle.toml",
            "[odometry]\nsigma_along_m_per_sqrt_m = 0.02\nsigma_heading_deg_per_sqrt_m = 0.5\n"
            "[[sensor]]\nreach_m = 15\nview_deg = [-180, 180]\nsigma_range_m = 0.05\nsigma_bearing_deg = 0.2\n");
  std::string all;
  for (const std::string& remark : log.recording().remarks) all += remark + '\n';
  return all;
}

TEST(OwnHandedness, IsNotDoubtedWhereBearingsAndTurnsAreOfOneSense) { EXPECT_EQ(remarks_on_rounds({}), ""); }

TEST(OwnHandedness, IsDoubtedWhereBearingsAreCountedClockwise) {
  const std::string all = remarks_on_rounds({-1.0, 1.0});
  EXPECT_NE(all.find("are bearings or turns counted clockwise?"), std::string::npos) << all;
}

TEST(OwnHandedness, IsDoubtedWhereTurnsAreCountedClockwise) {
  const std::string all = remarks_on_rounds({1.0, -1.0});
  EXPECT_NE(all.find("are bearings or turns counted clockwise?"), std::string::npos) << all;
}

TEST(OwnHandedness, IsNotDoubtedWithoutTurns) { EXPECT_EQ(remarks_on_rounds({-1.0, 1.0}, 0.0), ""); }

}  // namespace
}  // namespace helixnav::logs
