// SPDX-License-Identifier: BSD-3-Clause
//
// Figure 14 of fastslam_nieto2003: two robots, alone with 500 particles each and together with 800, both poses in a
// particle. Ours, because the paper is silent: 40 × 30 m with 30 beacons, circles of 9 m radius whose views overlap, 188 s
// at 1 m/s, a scan every 0.2 s, 0.15 m and 1.5°, detection 0.9 within 10 m in front, starts known. The EKF beside it is
// the dense one over both robots, associations known; beside that team::Team, which solves its graph every few seconds.
#include <array>

#include "fastslam_study.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/team/team.hpp"
#include "team_ekf.hpp"

namespace helixnav::bench {
namespace {

using fastslam::Association;
using fastslam::Proposal;

struct RobotsWorld {
  std::vector<core::Pose2> starts{{22.0, 15.0, core::pi / 2.0}, {18.0, 15.0, core::pi / 2.0}};
  std::vector<DrivenScan> drive;
};

DrivenScan drive_and_see(const std::vector<Eigen::Vector2d>& landmarks_m, core::Pose2& truth, std::size_t robot, int i,
                         core::RandomStream& random) {
  constexpr double period_s = 0.2, speed = 1.0, sigma_speed = 0.2, sigma_turn = 0.06, sigma_range_m = 0.15;
  const double turn = (robot == 0 ? 1.0 : -1.0) * speed / 9.0, sigma_bearing_rad = 1.5 * core::pi / 180.0;
  DrivenScan driven;
  driven.robot = robot;
  driven.truth = truth = core::compose(truth, unicycle(speed, turn, period_s, 0.0, 0.0).T_before_after);
  driven.odometry =
      unicycle(random.normal(speed, sigma_speed), random.normal(turn, sigma_turn), period_s, sigma_speed, sigma_turn);
  driven.scan.t_ns = core::nanoseconds_from_seconds((i + 1) * period_s);
  driven.scan.field_of_view = {0.0, 10.0, -core::pi / 2.0, core::pi / 2.0};
  for (std::size_t k = 0; k < landmarks_m.size(); ++k) {
    const Eigen::Vector2d p = core::transform(core::inverse(truth), landmarks_m[k]);
    const double range_m = p.norm(), bearing_rad = std::atan2(p.y(), p.x());
    if (range_m > 10.0 || std::abs(bearing_rad) > core::pi / 2.0 || !random.bernoulli(0.9)) continue;
    driven.scan.observations.push_back(core::make_range_bearing(
        std::max(0.05, random.normal(range_m, sigma_range_m)),
        core::wrap_to_pi(random.normal(bearing_rad, sigma_bearing_rad)), sigma_range_m, sigma_bearing_rad));
    driven.names.push_back(static_cast<fastslam::KnownName>(k));
  }
  return driven;
}

RobotsWorld make_world(int run) {
  core::RandomStream random(static_cast<std::uint64_t>(5000 + run), "two robots");
  std::vector<Eigen::Vector2d> landmarks_m;
  while (landmarks_m.size() < 30) {
    const Eigen::Vector2d p(random.uniform(0.0, 40.0), random.uniform(0.0, 30.0));
    const bool free = std::none_of(landmarks_m.begin(), landmarks_m.end(),
                                   [&](const Eigen::Vector2d& q) { return (p - q).norm() <= 2.0; });
    if (free) landmarks_m.push_back(p);
  }
  RobotsWorld world;
  std::vector<core::Pose2> truth = world.starts;
  for (int i = 0; i < 940; ++i) {
    for (const std::size_t robot : {0U, 1U}) {
      world.drive.push_back(drive_and_see(landmarks_m, truth[robot], robot, i, random));
    }
  }
  return world;
}

/// RMSE of the position of both robots.
using Errors = std::array<double, 2>;

template <class Estimate>
void add_error(const DrivenScan& driven, const Estimate& pose, Errors& squares) {
  squares[driven.robot] += (pose.position_m() - driven.truth.position_m()).squaredNorm() / 940.0;
}

Errors roots(const Errors& squares) { return {std::sqrt(squares[0]), std::sqrt(squares[1])}; }

Errors together(const RobotsWorld& world, const fastslam::Options& options, int seed) {
  Errors squares{};
  std::vector<core::PoseGaussian> starts;
  for (const core::Pose2& start : world.starts) starts.push_back({start, Eigen::Matrix3d::Zero()});
  fastslam::FastSlam slam(starts, options, static_cast<std::uint64_t>(seed));
  for (const DrivenScan& driven : world.drive) {
    add_error(driven, step(slam, driven, options.association == Association::known).pose.mean, squares);
  }
  return roots(squares);
}

Errors alone(const RobotsWorld& world, const fastslam::Options& options, int seed) {
  Errors squares{};
  for (const std::size_t robot : {0U, 1U}) {
    fastslam::FastSlam slam({world.starts[robot], Eigen::Matrix3d::Zero()}, options, static_cast<std::uint64_t>(seed));
    for (DrivenScan driven : world.drive) {
      if (driven.robot != robot) continue;
      driven.robot = 0;
      const core::Pose2 pose = step(slam, driven, options.association == Association::known).pose.mean;
      driven.robot = robot;
      add_error(driven, pose, squares);
    }
  }
  return roots(squares);
}

Errors kalman(const RobotsWorld& world, bool as_team) {
  Errors squares{};
  std::vector<TeamEkf> filters(as_team ? 1 : 2, TeamEkf(world.starts));
  for (const DrivenScan& driven : world.drive) {
    TeamEkf& filter = filters[as_team ? 0 : driven.robot];
    filter.predict(driven.odometry, driven.robot);
    filter.observe(driven.scan, driven.names, driven.robot);
    add_error(driven, filter.pose(driven.robot).mean, squares);
  }
  return roots(squares);
}

/// team::Team; alone: with two names for each landmark. The estimate is the one at the time.
Errors graph(const RobotsWorld& world, bool as_team) {
  Errors squares{};
  std::vector<std::optional<core::PoseGaussian>> starts;
  for (const core::Pose2& start : world.starts) starts.emplace_back(core::PoseGaussian{start, Eigen::Matrix3d::Zero()});
  team::Team robots(starts);
  for (const DrivenScan& driven : world.drive) {
    const int robot = static_cast<int>(driven.robot);
    core::Odometry odometry = driven.odometry;
    odometry.t_ns = driven.scan.t_ns;
    robots.take(robot, odometry);
    std::vector<std::int64_t> names(driven.names.begin(), driven.names.end());
    for (std::int64_t& name : names) name += as_team ? 0 : 1000 * robot;
    add_error(driven, robots.take(robot, driven.scan, names).value().pose.mean, squares);
  }
  return roots(squares);
}

struct Comparison {
  std::array<std::vector<double>, 4> errors;  ///< alone robot 1, 2; together robot 1, 2
  int better = 0;

  void add(const Errors& lone, const Errors& team) {
    for (std::size_t r = 0; r < 2; ++r) errors[r].push_back(lone[r]), errors[2 + r].push_back(team[r]);
    better += team[0] + team[1] < lone[0] + lone[1];
  }
  void print(const char* name, int runs) const {
    const double a = mean(errors[0]) + mean(errors[1]), b = mean(errors[2]) + mean(errors[3]);
    std::printf("  %-12s alone %.3f / %.3f m, together %.3f / %.3f m (%+.0f %%), together better in %s\n", name,
                mean(errors[0]), mean(errors[1]), mean(errors[2]), mean(errors[3]), 100.0 * (b / a - 1.0),
                share(better, runs).c_str());
    std::fflush(stdout);
  }
};

}  // namespace

int run_robots(const StudySettings& settings, const std::string& only) {
  const int runs = settings.runs != 0 ? settings.runs : 30;
  const std::size_t joint = settings.particles != 0 ? settings.particles : 800;
  const std::size_t single = 5 * joint / 8;
  std::printf("two robots, %d runs, %zu particles alone, %zu together: position RMSE, mean over runs, robot 1 / 2\n",
              runs, single, joint);
  Comparison ekf, smoothed;
  for (int run = 0; run < runs && only.empty(); ++run) {
    const RobotsWorld world = make_world(run);
    ekf.add(kalman(world, false), kalman(world, true));
    smoothed.add(graph(world, false), graph(world, true));
  }
  if (only.empty()) {
    ekf.print("EKF known", runs);
    smoothed.print("Team known", runs);
  }
  const std::vector<Method> methods{{"FS1 known", false, Proposal::motion, Association::known},
                                    {"FS2 known", false, Proposal::motion_and_scan, Association::known},
                                    {"FS2 lr", false, Proposal::motion_and_scan, Association::likelihood_ratio}};
  for (const Method& method : methods) {
    if (!only.empty() && method.name != only) continue;
    fastslam::Options base;
    base.threads = settings.threads;
    fastslam::Options options = method.options(base);
    if (method.known()) options.existence.remove = false;
    Comparison comparison;
    for (int run = 0; run < runs; ++run) {
      const RobotsWorld world = make_world(run);
      options.particles = single;
      const Errors lone = alone(world, options, 9 + run);
      options.particles = joint;
      comparison.add(lone, together(world, options, 9 + run));
    }
    comparison.print(method.name.c_str(), runs);
  }
  return 0;
}

}  // namespace helixnav::bench
