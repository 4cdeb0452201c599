// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "joint_filter.hpp"
#include "small_team.hpp"

namespace helixnav::team {
namespace {

using testing::small_team;
using testing::SmallTeam;
using testing::SmallTeamOptions;

Eigen::Matrix3d lost_by(double sigma_rad) { return Eigen::Vector3d(0.05, 0.05, sigma_rad).cwiseAbs2().asDiagonal(); }

core::Observation look_at(const core::Pose2& from, const Eigen::Vector2d& point_m, core::RandomStream& random) {
  const core::ObsVector z =
      core::predict_observation(core::ObservationKind::range_bearing, from, core::Pose2(), point_m).z_hat;
  const double range_m = z[0] + random.normal(0.0, 0.1);
  const double bearing_rad = z[1] + random.normal(0.0, 0.02);
  return core::make_range_bearing(range_m, bearing_rad, 0.1, 0.02);
}

/// A robot that does not know its heading, far from the origin, among four landmarks that it begins and three old ones,
/// which are well known and are seen only if `sees_old`.
struct LostRobot {
  core::Pose2 truth;
  JointFilter filter;
  double least_sigma_rad = 0.0;  ///< while it saw only what it had begun
};

LostRobot drive_lost(double sigma_rad, bool sees_old, std::uint64_t seed) {
  core::RandomStream random(seed, "lost_heading");
  const std::vector<Eigen::Vector2d> old{{14.0, 2.0}, {24.0, 3.0}, {20.0, -7.0}};
  const std::vector<Eigen::Vector2d> begun{{23.0, 0.0}, {18.0, 4.0}, {17.0, -3.0}, {22.0, -4.0}};
  Eigen::MatrixXd P = 1e-4 * Eigen::MatrixXd::Identity(9, 9);
  P.topLeftCorner<3, 3>() = lost_by(sigma_rad);
  const core::Pose2 start(20.0, 0.0, 1.0);
  LostRobot lost;
  lost.truth = core::Pose2(Eigen::Vector3d(start.vector() + random.normal3(P.topLeftCorner<3, 3>())));
  std::vector<Eigen::Vector2d> known_m = old;
  for (Eigen::Vector2d& point_m : known_m) point_m += random.normal3(1e-4 * Eigen::Matrix3d::Identity()).head<2>();
  lost.filter = JointFilter({start}, {100, 101, 102}, known_m, P);
  lost.least_sigma_rad = sigma_rad;
  for (int step = 0; step < 60; ++step) {
    const core::Pose2 way(0.2, 0.0, 0.1);
    core::Odometry motion;
    motion.covariance = Eigen::Vector3d(0.01, 0.002, 0.003).cwiseAbs2().asDiagonal();
    motion.T_before_after = core::Pose2(Eigen::Vector3d(way.vector() + random.normal3(motion.covariance)));
    lost.truth = core::compose(lost.truth, way);
    lost.filter.predict(0, motion);
    for (std::size_t i = 0; i < begun.size(); ++i) {
      const auto id = static_cast<core::LandmarkId>(i);
      const core::Observation seen = look_at(lost.truth, begun[i], random);
      if (lost.filter.contains(id)) {
        lost.filter.observe(0, id, core::Pose2(), seen, 1e9);
      } else {
        lost.filter.augment(0, id, core::Pose2(), seen);
      }
    }
    lost.least_sigma_rad = std::min(lost.least_sigma_rad, std::sqrt(lost.filter.pose(0).covariance(2, 2)));
  }
  for (std::size_t i = 0; sees_old && i < old.size(); ++i) {
    const auto id = static_cast<core::LandmarkId>(100 + i);
    lost.filter.observe(0, id, core::Pose2(), look_at(lost.truth, old[i], random), 1e9);
  }
  return lost;
}

TEST(LostHeading, IsNotFoundAgainInWhatWasBegunSince) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    EXPECT_GT(drive_lost(0.3, false, seed).least_sigma_rad, 0.3 * (1.0 - 1e-6)) << seed;
  }
}

TEST(LostHeading, IsFoundAgainInWhatWasKnownBeforeAsWellAsStated) {
  constexpr int draws = 300;
  double nees = 0.0;
  for (int draw = 0; draw < draws; ++draw) {
    const LostRobot lost = drive_lost(0.15, true, static_cast<std::uint64_t>(1000 + draw));
    const core::PoseGaussian pose = lost.filter.pose(0);
    EXPECT_LT(std::sqrt(pose.covariance(2, 2)), 0.03);
    const Eigen::Vector3d error = testing::difference(pose.mean, lost.truth);
    nees += error.dot(pose.covariance.inverse() * error) / draws;
  }
  EXPECT_NEAR(nees, 3.0, 3.5 * std::sqrt(6.0 / draws));  // σ of a mean of χ² with three degrees of freedom
}

/// Two robots on circles, of which neither knows its heading; they see no common landmark and not each other.
TEST(LostHeading, OfARobotOfATeamIsNotFoundAgain) {
  SmallTeamOptions options;
  options.see_each_other = false;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    options.seed = seed;
    const SmallTeam small = small_team(options);
    std::vector<std::optional<core::PoseGaussian>> starts;
    for (const core::Pose2& start : small.starts) starts.push_back(core::PoseGaussian{start, lost_by(0.3)});
    TeamOptions at_the_end;
    at_the_end.solve_every_s = 1e6;
    at_the_end.join.by_names = false;
    Team team(starts, at_the_end);
    double least_rad = 0.3;
    for (const testing::Message& message : small.messages) {
      const std::optional<core::StepReport> report = testing::give(team, message);
      if (report) least_rad = std::min(least_rad, std::sqrt(report->pose.covariance(2, 2)));
    }
    EXPECT_GT(least_rad, 0.3 * (1.0 - 1e-4)) << seed;
  }
}

}  // namespace
}  // namespace helixnav::team
