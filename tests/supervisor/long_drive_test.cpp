// SPDX-License-Identifier: BSD-3-Clause
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/supervisor/navigator.hpp"
#include "sanitized.hpp"

namespace helixnav::supervisor {
namespace {

constexpr double radius_m = 20.0;
constexpr int scans_a_lap = 60;

std::vector<Eigen::Vector2d> posts_beside_a_circle() {
  std::vector<Eigen::Vector2d> posts_m;
  for (int i = 0; i < 15; ++i) {
    const double angle_rad = 2.0 * core::pi * (i + 0.2 * std::sin(7.0 * i)) / 15;
    posts_m.emplace_back((radius_m + (i % 2 == 0 ? 4.0 : -5.0)) *
                         Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
  }
  return posts_m;
}

/// The vehicle relative to the centre of the circle after this many scans.
core::Pose2 on_circle(int scan) {
  const double angle_rad = 2.0 * core::pi * scan / scans_a_lap;
  return core::Pose2(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), angle_rad + core::pi / 2);
}

core::Scan scan_at(int scan, int place, const std::vector<Eigen::Vector2d>& posts_m) {
  core::Scan seen;
  seen.t_ns = 1'000'000'000LL * scan;
  seen.field_of_view.max_range_m = 15.0;
  const core::Pose2 T_robot_circle = core::inverse(on_circle(place));
  for (const Eigen::Vector2d& post_m : posts_m) {
    const Eigen::Vector2d at_m = core::transform(T_robot_circle, post_m);
    if (at_m.norm() > 15.0) continue;
    core::Observation observation;
    observation.kind = core::ObservationKind::range_bearing;
    observation.z = Eigen::Vector2d(at_m.norm(), std::atan2(at_m.y(), at_m.x()));
    observation.R = Eigen::Vector2d(0.01, 1e-4).asDiagonal();
    seen.observations.push_back(observation);
  }
  return seen;
}

core::Odometry one_scan_on() {
  core::Odometry motion = core::no_motion(0);
  motion.T_before_after = core::between(on_circle(0), on_circle(1));
  motion.covariance = Eigen::Vector3d(0.02, 0.01, 0.005).cwiseAbs2().asDiagonal();
  return motion;
}

std::size_t allocated_bytes() { return support::sanitized ? 0 : mallinfo2().uordblks; }

/// Growth of allocated memory from scan `settled` to scan `end` for a vehicle that stops after scan `parked`.
std::size_t growth_bytes(int settled, int end, int parked) {
  NavigatorOptions options;
  options.search.smooth_up_to_scans = 400;
  options.search.relocalizer.threads = 1;
  Navigator navigator({}, options);
  const std::vector<Eigen::Vector2d> posts_m = posts_beside_a_circle();
  std::size_t settled_bytes = 0, most_bytes = 0;
  for (int scan = 1; scan <= end; ++scan) {
    core::Odometry motion = one_scan_on();
    motion.t_ns = 1'000'000'000LL * scan;
    if (scan > parked) motion.T_before_after = core::Pose2();
    navigator.move(motion);
    navigator.observe(scan_at(scan, std::min(scan, parked), posts_m));
    std::size_t& most = scan <= settled ? settled_bytes : most_bytes;
    most = std::max(most, allocated_bytes());
  }
  EXPECT_EQ(navigator.map().size(), posts_m.size());
  return most_bytes > settled_bytes ? most_bytes - settled_bytes : 0;
}

}  // namespace

/// The atlas takes in what the tape holds, even if one filter holds the map for ever. What a condensed phase leaves
/// behind in the atlas's tables is a seventh of what a scan takes on the tape.
TEST(LongDrive, OnTheSameGroundIsTakenOffTheTape) {
  constexpr int settled = 3000, end = 8000;
  constexpr std::size_t bytes_a_scan = 300;  // 900 on the tape
  EXPECT_LE(growth_bytes(settled, end, end), (end - settled) * bytes_a_scan);
}

/// What a stationary vehicle sees again and again is not kept.
TEST(LongDrive, ThatPausesIsTakenOffTheTape) {
  constexpr int settled = 3000, end = 8000, parked = 1000;
  constexpr std::size_t bytes_a_scan = 100;
  EXPECT_LE(growth_bytes(settled, end, parked), (end - settled) * bytes_a_scan);
}

}  // namespace helixnav::supervisor
