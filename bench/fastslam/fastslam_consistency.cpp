// SPDX-License-Identifier: BSD-3-Clause
//
// Consistency over three laps of a circle of 94 m, associations known: NEES of the pose (3 if consistent), share of
// steps inside the 95 % ellipsoid, RMSE by lap, distinct ancestors a lap ago. The EKF beside it is dense.
#include <array>

#include <Eigen/LU>

#include "fastslam_study.hpp"
#include "helixnav/core/random.hpp"
#include "team_ekf.hpp"

namespace helixnav::bench {
namespace {

constexpr int laps = 3;
constexpr double radius_m = 15.0, speed_mps = 1.5, period_s = 0.2;
const int scans_a_lap = static_cast<int>(2.0 * core::pi * radius_m / speed_mps / period_s);
const core::Pose2 T_world_start(radius_m, 0.0, core::pi / 2.0);

std::vector<DrivenScan> make_drive(int run) {
  core::RandomStream random(static_cast<std::uint64_t>(31000 + run), "three laps");
  std::vector<Eigen::Vector2d> landmarks_m;
  for (int k = 0; k < 40; ++k) {
    const double a = random.uniform(-core::pi, core::pi), r = radius_m + random.uniform(-7.0, 7.0);
    landmarks_m.emplace_back(r * std::cos(a), r * std::sin(a));
  }
  std::vector<DrivenScan> drive;
  core::Pose2 truth = T_world_start;
  const double turn = speed_mps / radius_m, sigma_speed = 0.15, sigma_turn = 0.05;
  const double sigma_range_m = 0.15, sigma_bearing_rad = 1.5 * core::pi / 180.0;
  for (int i = 0; i < laps * scans_a_lap; ++i) {
    DrivenScan driven;
    driven.truth = truth = core::compose(truth, unicycle(speed_mps, turn, period_s, 0.0, 0.0).T_before_after);
    driven.odometry = unicycle(random.normal(speed_mps, sigma_speed), random.normal(turn, sigma_turn), period_s,
                               sigma_speed, sigma_turn);
    driven.scan.t_ns = core::nanoseconds_from_seconds((i + 1) * period_s);
    driven.scan.field_of_view = {0.0, 8.0, -core::pi / 2.0, core::pi / 2.0};
    for (std::size_t k = 0; k < landmarks_m.size(); ++k) {
      const Eigen::Vector2d p = core::transform(core::inverse(truth), landmarks_m[k]);
      const double range_m = p.norm(), bearing_rad = std::atan2(p.y(), p.x());
      if (range_m > 8.0 || std::abs(bearing_rad) > core::pi / 2.0 || !random.bernoulli(0.8)) continue;
      driven.scan.observations.push_back(core::make_range_bearing(
          std::max(0.05, random.normal(range_m, sigma_range_m)),
          core::wrap_to_pi(random.normal(bearing_rad, sigma_bearing_rad)), sigma_range_m, sigma_bearing_rad));
      driven.names.push_back(static_cast<fastslam::KnownName>(k));
    }
    drive.push_back(std::move(driven));
  }
  return drive;
}

struct LapStatistics {
  std::array<std::vector<double>, laps> nees;
  std::array<double, laps> squares{}, inside{};
  std::array<int, laps> count{};
  std::vector<double> ancestors, effective;

  void add(int i, const core::PoseGaussian& pose, const core::Pose2& truth) {
    const auto lap = static_cast<std::size_t>(i / scans_a_lap);
    Eigen::Vector3d d = pose.mean.vector() - truth.vector();
    d[2] = core::wrap_to_pi(d[2]);
    Eigen::Matrix3d C = pose.covariance;
    C.diagonal() += Eigen::Vector3d(1e-6, 1e-6, 1e-8);  // a cloud of one line of descent has no covariance of its own
    const double nees_now = d.dot(C.inverse() * d);
    nees[lap].push_back(nees_now);
    inside[lap] += nees_now < 7.815;
    squares[lap] += d.head<2>().squaredNorm();
    ++count[lap];
  }
  void print(const std::string& name) const {
    std::printf("  %-12s median NEES", name.c_str());
    for (std::size_t l = 0; l < laps; ++l) std::printf(" %.1f", quantile(nees[l], 0.5));
    std::printf(", mean");
    for (std::size_t l = 0; l < laps; ++l) std::printf(" %.3g", mean(nees[l]));
    std::printf(" | inside 95 %%:");
    for (std::size_t l = 0; l < laps; ++l) std::printf(" %.0f", 100.0 * inside[l] / count[l]);
    std::printf(" %% | RMSE");
    for (std::size_t l = 0; l < laps; ++l) std::printf(" %.2f", std::sqrt(squares[l] / count[l]));
    std::printf(" m");
    if (!ancestors.empty())
      std::printf(" | ESS share %.2f, ancestors a lap ago %.1f", mean(effective), mean(ancestors));
    std::printf("\n");
    std::fflush(stdout);
  }
};

LapStatistics run_kalman(int runs) {
  LapStatistics statistics;
  for (int run = 0; run < runs; ++run) {
    const std::vector<DrivenScan> drive = make_drive(run);
    TeamEkf filter({T_world_start});
    for (std::size_t i = 0; i < drive.size(); ++i) {
      filter.predict(drive[i].odometry, 0);
      filter.observe(drive[i].scan, drive[i].names, 0);
      statistics.add(static_cast<int>(i), filter.pose(0), drive[i].truth);
    }
  }
  return statistics;
}

LapStatistics run_particles(int runs, const fastslam::Options& options) {
  LapStatistics statistics;
  for (int run = 0; run < runs; ++run) {
    const std::vector<DrivenScan> drive = make_drive(run);
    fastslam::FastSlam slam({T_world_start, Eigen::Matrix3d::Zero()}, options, static_cast<std::uint64_t>(3 + run));
    for (std::size_t i = 0; i < drive.size(); ++i) {
      statistics.add(static_cast<int>(i), step(slam, drive[i], true).pose, drive[i].truth);
      statistics.effective.push_back(slam.cloud().effective_size / static_cast<double>(options.particles));
      if ((i + 1) % static_cast<std::size_t>(scans_a_lap) == 0) {
        statistics.ancestors.push_back(static_cast<double>(slam.cloud().distinct_ancestors));
      }
    }
  }
  return statistics;
}

}  // namespace

int run_consistency(const StudySettings& settings) {
  const int runs = settings.runs != 0 ? settings.runs : 20;
  std::printf("three laps of %.0f m, %d runs: by lap\n", 2.0 * core::pi * radius_m, runs);
  run_kalman(runs).print("EKF");
  std::vector<std::size_t> counts{100, 500, 5000};
  if (settings.particles != 0) counts = {settings.particles};
  for (const std::size_t particles : counts) {
    for (const fastslam::Proposal proposal : {fastslam::Proposal::motion, fastslam::Proposal::motion_and_scan}) {
      fastslam::Options options;
      options.particles = particles;
      options.proposal = proposal;
      options.association = fastslam::Association::known;
      options.existence.remove = false;
      options.weigh_unseen = false;
      options.genealogy_m = 2.0 * core::pi * radius_m * 0.95;
      options.threads = settings.threads;
      char name[32];
      std::snprintf(name, sizeof name, "FS%d M=%zu", proposal == fastslam::Proposal::motion ? 1 : 2, particles);
      run_particles(runs, options).print(name);
    }
  }
  return 0;
}

}  // namespace helixnav::bench
