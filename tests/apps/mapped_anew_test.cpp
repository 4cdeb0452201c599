// SPDX-License-Identifier: BSD-3-Clause
#include "team/mapped_anew.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/random.hpp"

namespace helixnav::apps {
namespace {

constexpr double sigma_range_m = 0.03, sigma_bearing_rad = 0.005, sigma_way_m = 0.03, sigma_turn_rad = 0.01;
constexpr int slip_at = 110;

std::vector<Eigen::Vector2d> trees() {
  core::RandomStream random(3, "trees");
  std::vector<Eigen::Vector2d> points_m;
  for (int column = -4; column <= 4; ++column) {
    for (int row = -4; row <= 4; ++row) {
      const double x_m = 5.0 * column + random.uniform(-1.5, 1.5);
      points_m.emplace_back(x_m, 5.0 * row + random.uniform(-1.5, 1.5));
    }
  }
  return points_m;
}

/// Three times round a circle of 10 m radius; what is ahead within 9 m is in view; odometry does not show the slip.
core::TeamMember drive_round(const core::Pose2& slip) {
  const std::vector<Eigen::Vector2d> points_m = trees();
  core::RandomStream random(4, "drive");
  core::TeamMember member;
  member.number = 1;
  core::Pose2 truth(0.0, -10.0, 0.0);
  member.recording.start.mean = truth;
  for (int second = 1; second <= 190; ++second) {
    const core::Pose2 way(1.0, 0.05, 0.1);
    core::Odometry odometry;
    odometry.t_ns = 1'000'000'000LL * second;
    odometry.covariance = Eigen::Vector3d(sigma_way_m, sigma_way_m, sigma_turn_rad).cwiseAbs2().asDiagonal();
    odometry.T_before_after = core::Pose2(Eigen::Vector3d(way.vector() + random.normal3(odometry.covariance)));
    truth = core::compose(truth, way);
    if (second == slip_at) truth = core::compose(truth, slip);
    core::Scan scan;
    scan.t_ns = odometry.t_ns;
    for (const Eigen::Vector2d& point_m : points_m) {
      const Eigen::Vector2d at_m = core::transform(core::inverse(truth), point_m);
      if (at_m.norm() > 9.0 || at_m.x() < 0.0) continue;
      const double range_m = at_m.norm() + random.normal(0.0, sigma_range_m);
      const double bearing_rad = std::atan2(at_m.y(), at_m.x()) + random.normal(0.0, sigma_bearing_rad);
      scan.observations.push_back(core::make_range_bearing(range_m, bearing_rad, sigma_range_m, sigma_bearing_rad));
    }
    member.recording.labels.emplace_back(scan.observations.size(), core::no_label);
    member.recording.events.emplace_back(odometry);
    member.recording.events.emplace_back(scan);
  }
  return member;
}

std::optional<MappedAnew> judged(const core::Pose2& slip) {
  TeamTask task;
  task.recording.robots = {drive_round(slip)};
  task.known_association = false;
  task.options.join.by_names = false;
  task.quiet = true;
  return mapped_anew(drive_team(task), 0);
}

TEST(MappedAnew, TellsWhenARobotSlippedWithoutNames) {
  const std::optional<MappedAnew> anew = judged({1.5, 1.0, 0.5});
  ASSERT_TRUE(anew.has_value());
  EXPECT_GT(core::seconds(anew->to_ns), slip_at);
  EXPECT_LT(core::seconds(anew->from_ns), slip_at + 20.0);
}

TEST(MappedAnew, IsSilentWhereNothingIsWrong) { EXPECT_FALSE(judged({}).has_value()); }

}  // namespace
}  // namespace helixnav::apps
