// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/handedness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <deque>
#include <optional>
#include <variant>
#include <vector>

#include <Eigen/LU>

#include "helixnav/core/chi2.hpp"
#include "helixnav/core/odometry.hpp"

namespace helixnav::logs {
namespace {

/// A scan is compared with the first later one of its sensor by which the vehicle has turned this far; at most this
/// many scans later, since the motion between becomes less certain and what was seen leaves the view.
constexpr double least_turn_rad = 0.1;
constexpr std::size_t most_scans_apart = 10;

/// Per scan: enough to decide, and few enough to be fast for a sensor with many.
constexpr std::size_t most_points = 64;

struct Point {
  Eigen::Vector2d position_m;  ///< in the frame of the sensor
  Eigen::Matrix2d covariance_m2;
};

struct PastScan {
  core::Pose2 T_robot_sensor;
  core::Odometry since;  ///< of the robot, from this scan on
  std::vector<Point> points;
};

/// How many points of a scan are found again in a later one by only one of two ways of reading the log. What both find
/// is not informative: a vehicle that turned little, a landmark straight ahead.
struct FoundByOne {
  std::size_t as_it_stands = 0, by_other = 0;

  void add(bool is_as_it_stands, bool is_by_other) {
    as_it_stands += is_as_it_stands && !is_by_other ? 1 : 0;
    by_other += is_by_other && !is_as_it_stands ? 1 : 0;
  }
};

struct Found {
  FoundByOne other_bearings, other_turns;
};

std::vector<Point> points_of(const core::Scan& scan) {
  std::vector<Point> points;
  for (const core::Observation& z : scan.observations) {
    if (core::dimension(z.kind) != 2 || points.size() == most_points) continue;
    const core::LocatedLandmark located = core::locate_landmark(z, core::Pose2(), core::Pose2());
    points.push_back({located.point_world_m, located.G_z * z.R * located.G_z.transpose()});
  }
  return points;
}

/// The motion mirrored about the vehicle's longitudinal axis.
core::Pose2 mirrored(const core::Pose2& T) { return {T.x_m, -T.y_m, -T.heading_rad}; }

core::Pose2 between_sensors(const core::Pose2& T_robot_before, const core::Pose2& T_before_after,
                            const core::Pose2& T_robot_after) {
  return core::between(T_robot_before, core::compose(T_before_after, T_robot_after));
}

/// Where a point of the earlier scan is now, and how certain that is.
Point carried(const Point& point, const core::Pose2& T_before_after, const core::Odometry& motion) {
  const Eigen::Vector2d now_m = core::transform(core::inverse(T_before_after), point.position_m);
  const Eigen::Matrix2d R = core::rotation(-T_before_after.heading_rad);
  const Eigen::Vector2d across(-now_m.y(), now_m.x());
  return {now_m, R * (point.covariance_m2 + motion.covariance.topLeftCorner<2, 2>()) * R.transpose() +
                     motion.covariance(2, 2) * across * across.transpose()};
}

bool is_found(const Point& expected, const std::vector<Point>& points) {
  const double gate = core::chi2_quantile(0.95, 2);
  return std::any_of(points.begin(), points.end(), [&](const Point& seen) {
    const Eigen::Vector2d off_m = seen.position_m - expected.position_m;
    const Eigen::Matrix2d covariance_m2 = seen.covariance_m2 + expected.covariance_m2;
    return off_m.dot(covariance_m2.inverse() * off_m) < gate;
  });
}

void compare(const PastScan& before, const core::Pose2& T_robot_sensor, const std::vector<Point>& points,
             Found& found) {
  const core::Pose2& moved = before.since.T_before_after;
  const core::Pose2 as_it_stands = between_sensors(before.T_robot_sensor, moved, T_robot_sensor);
  const core::Pose2 other_turns = between_sensors(before.T_robot_sensor, mirrored(moved), T_robot_sensor);
  for (const Point& point : before.points) {
    const bool is_as_it_stands = is_found(carried(point, as_it_stands, before.since), points);
    // Negating the bearings of both scans is equivalent to mirroring the sensor motion with both as they are.
    const bool is_by_bearings = is_found(carried(point, mirrored(as_it_stands), before.since), points);
    const bool is_by_turns = is_found(carried(point, other_turns, before.since), points);
    found.other_bearings.add(is_as_it_stands, is_by_bearings);
    found.other_turns.add(is_as_it_stands, is_by_turns);
  }
}

bool is_of_same_sensor(const core::Pose2& a, const core::Pose2& b) { return a.vector() == b.vector(); }

/// Compares a scan with the latest of its sensor that the vehicle has turned from; that scan, and those before it, are
/// then dropped.
void compare_with_past(const core::Scan& scan, const std::vector<Point>& points, std::deque<PastScan>& past,
                       Found& found) {
  const auto turned = std::find_if(past.rbegin(), past.rend(), [&](const PastScan& before) {
    return is_of_same_sensor(before.T_robot_sensor, scan.T_robot_sensor) &&
           std::abs(before.since.T_before_after.heading_rad) >= least_turn_rad;
  });
  if (turned == past.rend()) return;
  compare(*turned, scan.T_robot_sensor, points, found);
  past.erase(past.begin(), turned.base());
}

Found count_found(const core::Recording& recording) {
  Found found;
  std::deque<PastScan> past;
  for (const core::Event& event : recording.events) {
    if (std::holds_alternative<core::Lost>(event)) past.clear();
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) {
      for (PastScan& before : past) before.since = core::chain(before.since, *odometry);
    }
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    std::vector<Point> points = points_of(*scan);
    if (!points.empty()) compare_with_past(*scan, points, past, found);
    past.push_back({scan->T_robot_sensor, core::no_motion(scan->t_ns), std::move(points)});
    if (past.size() > most_scans_apart) past.pop_front();
  }
  return found;
}

}  // namespace

std::optional<std::string> doubt_handedness(const core::Recording& recording) {
  constexpr std::size_t least_found = 30;
  constexpr std::size_t clear_ratio = 3;
  const Found all = count_found(recording);
  const bool bearings_fit_better = all.other_bearings.by_other >= all.other_turns.by_other;
  const FoundByOne& found = bearings_fit_better ? all.other_bearings : all.other_turns;
  if (found.by_other < least_found || found.by_other < clear_ratio * found.as_it_stands) return std::nullopt;
  std::array<char, 320> text{};
  std::snprintf(
      text.data(), text.size(),
      "while the vehicle turns, %zu detections are found again in a later scan as they stand, and %zu with bearings or "
      "turns of the other sign; are bearings or turns counted clockwise? Both are counter-clockwise",
      found.as_it_stands, found.by_other);
  return text.data();
}

}  // namespace helixnav::logs
