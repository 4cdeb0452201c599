// SPDX-License-Identifier: BSD-3-Clause
//
// Figures 2 and 3 of fastslam_nieto2003: two beacons at (4, 6.8) less than 20 cm apart, range noise 15 cm. Ours, because
// the paper is silent: separation 0.18 m in a random direction, bearing noise 1°, six other beacons far apart, a circle of
// 3 m radius at 1 m/s with a scan every 0.2 s, detection 0.9 within 9 m in front, 0.1 false alarms per scan. Judged
// by the heaviest particle: exactly two mature landmarks within 0.8 m of the pair, and whether the vector between them is
// right within 9 cm.
#include <array>

#include "fastslam_study.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/supervisor/named_navigator.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::bench {
namespace {

using fastslam::Association;
using fastslam::Proposal;

constexpr double period_s = 0.2, speed_mps = 1.0, radius_m = 3.0;
constexpr int laps = 3;
const int scans_a_lap = static_cast<int>(std::lround(2.0 * core::pi * radius_m / speed_mps / period_s));
const core::Pose2 T_world_start(7.0, 3.4, core::pi / 2.0);
const Eigen::Vector2d pair_m(4.0, 6.8);

struct PairWorld {
  std::vector<Eigen::Vector2d> landmarks_m;  ///< the pair comes first
  std::vector<DrivenScan> drive;
};

void see(PairWorld& world, DrivenScan& driven, bool one_return, core::RandomStream& random) {
  const double sigma_range_m = 0.15, sigma_bearing_rad = core::pi / 180.0;
  driven.scan.field_of_view = {0.0, 9.0, -core::pi / 2.0, core::pi / 2.0};
  struct Seen {
    core::Observation z;
    fastslam::KnownName name;
  };
  std::vector<Seen> seen;
  const int hidden = one_return ? static_cast<int>(random.below(2)) : -1;
  for (std::size_t k = 0; k < world.landmarks_m.size(); ++k) {
    const Eigen::Vector2d at = core::transform(core::inverse(driven.truth), world.landmarks_m[k]);
    const double range_m = at.norm(), bearing_rad = std::atan2(at.y(), at.x());
    const bool detected = random.bernoulli(0.9);
    if (range_m > 9.0 || std::abs(bearing_rad) > core::pi / 2.0 || !detected || static_cast<int>(k) == hidden) continue;
    seen.push_back({core::make_range_bearing(std::max(0.05, random.normal(range_m, sigma_range_m)),
                                             core::wrap_to_pi(random.normal(bearing_rad, sigma_bearing_rad)),
                                             sigma_range_m, sigma_bearing_rad),
                    static_cast<fastslam::KnownName>(k)});
  }
  if (random.bernoulli(0.1)) {
    seen.push_back({core::make_range_bearing(random.uniform(0.5, 9.0), random.uniform(-core::pi / 2, core::pi / 2),
                                             sigma_range_m, sigma_bearing_rad),
                    fastslam::no_name});
  }
  for (std::size_t i = seen.size(); i > 1; --i) std::swap(seen[i - 1], seen[random.below(i)]);
  for (const Seen& s : seen) driven.scan.observations.push_back(s.z), driven.names.push_back(s.name);
}

PairWorld make_world(int run, bool one_return) {
  core::RandomStream random(static_cast<std::uint64_t>(1000 + run), "pair of beacons");
  PairWorld world;
  const double angle = random.uniform(0.0, core::pi);
  const Eigen::Vector2d half_m = 0.09 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  const core::Pose2 T_start_world = core::inverse(T_world_start);
  for (const Eigen::Vector2d& p : std::initializer_list<Eigen::Vector2d>{pair_m - half_m,
                                                                         pair_m + half_m,
                                                                         {-2.0, 0.0},
                                                                         {10.0, 0.5},
                                                                         {-1.5, 7.5},
                                                                         {9.5, 8.0},
                                                                         {4.0, -3.5},
                                                                         {4.0, 12.0}}) {
    world.landmarks_m.push_back(core::transform(T_start_world, p));
  }
  core::Pose2 truth;
  const double turn = speed_mps / radius_m, sigma_speed = 0.1, sigma_turn = 0.05;
  for (int i = 0; i < laps * scans_a_lap; ++i) {
    DrivenScan driven;
    truth = core::compose(truth, unicycle(speed_mps, turn, period_s, 0.0, 0.0).T_before_after);
    driven.truth = truth;
    driven.odometry = unicycle(random.normal(speed_mps, sigma_speed), random.normal(turn, sigma_turn), period_s,
                               sigma_speed, sigma_turn);
    driven.scan.t_ns = driven.odometry.t_ns = core::nanoseconds_from_seconds((i + 1) * period_s);
    see(world, driven, one_return, random);
    world.drive.push_back(driven);
  }
  return world;
}

struct Verdict {
  bool two = false, near = false, vector = false;
  double landmarks = 0.0;
};

Verdict judge(const std::vector<Eigen::Vector2d>& mature_m, const PairWorld& world) {
  std::vector<Eigen::Vector2d> in;
  const Eigen::Vector2d centre_m = 0.5 * (world.landmarks_m[0] + world.landmarks_m[1]);
  for (const Eigen::Vector2d& p : mature_m) {
    if ((p - centre_m).norm() < 0.8) in.push_back(p);
  }
  Verdict verdict;
  verdict.landmarks = static_cast<double>(in.size());
  verdict.two = in.size() == 2;
  if (!verdict.two) return verdict;
  const auto& [a, b] = std::array{world.landmarks_m[0], world.landmarks_m[1]};
  const double straight = std::max((in[0] - a).norm(), (in[1] - b).norm());
  const double crossed = std::max((in[0] - b).norm(), (in[1] - a).norm());
  verdict.near = std::min(straight, crossed) < 0.15;
  const Eigen::Vector2d d = in[1] - in[0], t = b - a;
  verdict.vector = std::min((d - t).norm(), (d + t).norm()) < 0.09;
  return verdict;
}

std::vector<Eigen::Vector2d> mature_of(const std::vector<core::MapLandmark>& map) {
  std::vector<Eigen::Vector2d> points;
  for (const core::MapLandmark& l : map) {
    if (l.state == core::LandmarkState::mature) points.push_back(l.point.mean_m);
  }
  return points;
}

/// Verdicts after the first lap and after the last.
using Verdicts = std::array<Verdict, 2>;

template <class Navigator, class Observe>
Verdicts navigate(const PairWorld& world, Navigator navigator, const Observe& observe) {
  Verdicts verdicts;
  for (std::size_t i = 0; i < world.drive.size(); ++i) {
    navigator.move(world.drive[i].odometry);
    observe(navigator, world.drive[i]);
    if (i + 1 == static_cast<std::size_t>(scans_a_lap)) verdicts[0] = judge(mature_of(navigator.map()), world);
  }
  verdicts[1] = judge(mature_of(navigator.map()), world);
  return verdicts;
}

Verdicts run_kalman(const PairWorld& world, bool known) {
  if (known) {
    return navigate(world, supervisor::NamedNavigator(core::PoseGaussian{}),
                    [](auto& navigator, const DrivenScan& driven) { navigator.observe(driven.scan, driven.names); });
  }
  return navigate(world, supervisor::Navigator(core::PoseGaussian{}),
                  [](auto& navigator, const DrivenScan& driven) { navigator.observe(driven.scan); });
}

Verdicts run_particles(const PairWorld& world, const fastslam::Options& options, bool known, int run, double& us) {
  fastslam::FastSlam slam(core::PoseGaussian{}, options, static_cast<std::uint64_t>(77 + run));
  Verdicts verdicts;
  const double begin_us = processor_us();
  for (std::size_t i = 0; i < world.drive.size(); ++i) {
    step(slam, world.drive[i], known);
    if (i + 1 == static_cast<std::size_t>(scans_a_lap)) verdicts[0] = judge(mature_of(slam.map()), world);
  }
  us += (processor_us() - begin_us) / static_cast<double>(world.drive.size());
  verdicts[1] = judge(mature_of(slam.map()), world);
  return verdicts;
}

std::vector<Method> pair_methods() {
  const Proposal one = Proposal::motion, two = Proposal::motion_and_scan;
  return {{"compressed EKF known", true, two, Association::known},
          {"compressed EKF lr", true, two, Association::likelihood_ratio},
          {"FS2 known", false, two, Association::known},
          {"FS1 nn shared (paper)", false, one, Association::nearest_neighbour, false, false},
          {"FS1 nn exclusive", false, one, Association::nearest_neighbour, true, false},
          {"FS2 lr, no view term", false, two, Association::likelihood_ratio, true, false},
          {"FS1 mht as written", false, one, Association::multiple_hypotheses, false, false, false, false},
          {"FS1 mht, middle zone", false, one, Association::multiple_hypotheses, false, false, false, true},
          {"FS1 lr + view", false, one, Association::likelihood_ratio},
          {"FS2 lr + view", false, two, Association::likelihood_ratio},
          {"FS2 sampled + view", false, two, Association::sampled},
          {"FS2 mht + view", false, two, Association::multiple_hypotheses},
          {"FS1 mht n+2 + view", false, one, Association::multiple_hypotheses, true, true, true},
          {"FS2 mht n+2 + view", false, two, Association::multiple_hypotheses, true, true, true}};
}

}  // namespace

int run_pair(const StudySettings& settings, bool one_return) {
  const int runs = settings.runs != 0 ? settings.runs : 100;
  fastslam::Options base;
  base.particles = settings.particles != 0 ? settings.particles : 100;
  base.threads = settings.threads;
  base.detection_probability = one_return ? 0.6 : 0.9;
  base.new_density = 0.1;
  base.clutter_density = 0.1 / (8.5 * core::pi);
  base.hypotheses.most_children = 8;
  base.existence.detection_probability = one_return ? 0.45 : 0.7;
  std::printf("two beacons 0.18 m apart, %s a scan, %d runs, %zu particles, %d scans a lap\n",
              one_return ? "one of them" : "both", runs, base.particles, scans_a_lap);
  for (const Method& method : pair_methods()) {
    std::array<int, 2> two{}, vector{}, near{};
    double us = 0.0, landmarks = 0.0;
    fastslam::Options options = method.options(base);
    if (method.known()) options.existence.remove = false;
    for (int run = 0; run < runs; ++run) {
      const PairWorld world = make_world(run, one_return);
      const Verdicts v =
          method.kalman ? run_kalman(world, method.known()) : run_particles(world, options, method.known(), run, us);
      for (std::size_t at = 0; at < 2; ++at) two[at] += v[at].two, vector[at] += v[at].vector, near[at] += v[at].near;
      landmarks += v[1].landmarks / runs;
    }
    std::printf(
        "  %-24s two: lap 1 %-20s lap 3 %-20s | vector right: %3d, %-20s | both within 15 cm %3d, %3d | landmarks "
        "there %.2f, %.0f us\n",
        method.name.c_str(), share(two[0], runs).c_str(), share(two[1], runs).c_str(), vector[0],
        share(vector[1], runs).c_str(), near[0], near[1], landmarks, us / runs);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace helixnav::bench
