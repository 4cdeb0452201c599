// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "helixnav/atlas/atlas.hpp"
#include "helixnav/core/random.hpp"

namespace helixnav::bench {

/// Landmarks beside roads, seen within 25 m by a vehicle that drives in steps of 10 m; four steps make a phase.
class RoadWorld {
 public:
  double sigma_seen_m = 0.2;
  double sigma_heading_rad = 0.003;

  explicit RoadWorld(std::uint64_t seed) : random_(seed) {}

  void add_landmark(const Eigen::Vector2d& point_m) {
    cells_[cell(point_m)].push_back(static_cast<int>(landmarks_m_.size()));
    landmarks_m_.push_back(point_m);
  }
  int landmark_count() const { return static_cast<int>(landmarks_m_.size()); }

  /// Corners of a route, driven in steps of about 10 m.
  void drive_to(const Eigen::Vector2d& corner_m) {
    if (route_m_.empty()) {
      route_m_.push_back(corner_m);
      return;
    }
    const Eigen::Vector2d from_m = route_m_.back();
    const int steps = std::max(1, static_cast<int>(std::lround((corner_m - from_m).norm() / 10.0)));
    for (int i = 1; i <= steps; ++i) route_m_.push_back(from_m + (corner_m - from_m) * i / steps);
  }
  double driven_m() const { return 10.0 * static_cast<double>(route_m_.size() - 1); }
  const Eigen::Vector2d& at_m() const { return route_m_.back(); }

  /// The phases of the route from where the last call ended, at most `most`; about the truth, with noise in their residuals.
  /// `ends_m`: where they end.
  std::vector<std::shared_ptr<atlas::PhaseLog>> phases(std::vector<atlas::PhaseShape>& shapes,
                                                       std::size_t most = static_cast<std::size_t>(-1),
                                                       std::vector<Eigen::Vector2d>* ends_m = nullptr) {
    std::vector<std::shared_ptr<atlas::PhaseLog>> logs;
    for (; done_ + 4 < route_m_.size() && logs.size() < most; done_ += 4) {
      if (ends_m != nullptr) ends_m->push_back(route_m_[done_ + 4]);
      auto log = std::make_shared<atlas::PhaseLog>();
      std::map<int, Eigen::Vector2d> points_m;
      atlas::PhaseShape shape;
      const core::Pose2 entry = pose(done_);
      if (done_ == 0) log->seen_at_entry = look(entry, entry, points_m);
      for (std::size_t k = done_ + 1; k <= done_ + 4; ++k) {
        atlas::LoggedStep step;
        const Eigen::Vector3d sigma(0.05, 0.02, sigma_heading_rad);
        step.covariance = sigma.cwiseAbs2().asDiagonal();
        step.T_before_after = core::Pose2(
            Eigen::Vector3d(core::between(pose(k - 1), pose(k)).vector() + random_.normal3(step.covariance)));
        step.seen = look(pose(k), entry, points_m);
        shape.T_entry_robot.push_back(core::between(entry, pose(k)));
        log->steps.push_back(std::move(step));
      }
      for (const auto& [id, point_m] : points_m) {
        shape.ids.push_back(id);
        shape.points_m.push_back(point_m);
      }
      logs.push_back(std::move(log));
      shapes.push_back(std::move(shape));
    }
    return logs;
  }

 private:
  static std::pair<long, long> cell(const Eigen::Vector2d& p) {
    return {std::lround(std::floor(p.x() / 25.0)), std::lround(std::floor(p.y() / 25.0))};
  }

  core::Pose2 pose(std::size_t k) const {
    const Eigen::Vector2d along_m = k + 1 < route_m_.size() ? Eigen::Vector2d(route_m_[k + 1] - route_m_[k])
                                                            : Eigen::Vector2d(route_m_[k] - route_m_[k - 1]);
    return {route_m_[k].x(), route_m_[k].y(), std::atan2(along_m.y(), along_m.x())};
  }

  std::vector<atlas::SeenLandmark> look(const core::Pose2& robot, const core::Pose2& entry,
                                        std::map<int, Eigen::Vector2d>& points_m) {
    std::vector<atlas::SeenLandmark> seen;
    const auto [cx, cy] = cell(robot.position_m());
    for (long x = cx - 1; x <= cx + 1; ++x) {
      for (long y = cy - 1; y <= cy + 1; ++y) {
        const auto found = cells_.find({x, y});
        if (found == cells_.end()) continue;
        for (const int i : found->second) {
          const Eigen::Vector2d& point_m = landmarks_m_[static_cast<std::size_t>(i)];
          if ((point_m - robot.position_m()).norm() > 25.0) continue;
          const Eigen::Vector2d seen_m = core::transform(core::inverse(robot), point_m);
          const double dx = random_.normal(0.0, sigma_seen_m);
          const double dy = random_.normal(0.0, sigma_seen_m);
          const Eigen::Matrix2d R = sigma_seen_m * sigma_seen_m * Eigen::Matrix2d::Identity();
          seen.push_back({i, core::Pose2(), core::make_cartesian(seen_m + Eigen::Vector2d(dx, dy), R)});
          points_m[i] = core::transform(core::inverse(entry), point_m);
        }
      }
    }
    return seen;
  }

  core::RandomStream random_;
  std::vector<Eigen::Vector2d> landmarks_m_;
  std::map<std::pair<long, long>, std::vector<int>> cells_;
  std::vector<Eigen::Vector2d> route_m_;
  std::size_t done_ = 0;
};

/// Streets 100 m apart with a landmark every 8 m on both sides, each driven once.
inline RoadWorld street_grid(int landmarks, int& streets) {
  RoadWorld world(1);
  streets = static_cast<int>(std::lround(std::sqrt(landmarks / 50.0) + 0.5));
  const double end_m = 100.0 * (streets - 1);
  for (int i = 0; i < streets; ++i) {
    for (double along_m = 4.0; along_m < end_m; along_m += 8.0) {
      for (const double side_m : {-6.0, 6.0}) {
        world.add_landmark({along_m, 100.0 * i + side_m});
        world.add_landmark({100.0 * i + side_m, along_m});
      }
    }
  }
  for (int i = 0; i < streets; ++i) {
    world.drive_to({i % 2 == 0 ? 0.0 : end_m, 100.0 * i});
    world.drive_to({i % 2 == 0 ? end_m : 0.0, 100.0 * i});
  }
  const bool at_right = world.at_m().x() > 1.0;
  for (int j = 0; j < streets; ++j) {
    const double x_m = 100.0 * (at_right ? streets - 1 - j : j);
    const double y_m = world.at_m().y();
    world.drive_to({x_m, y_m});
    world.drive_to({x_m, y_m < 1.0 ? end_m : 0.0});
  }
  return world;
}

/// A straight road, then a loop of 4 km that ends `beyond_m` after its beginning; a landmark every 8 m on both sides.
inline RoadWorld road_and_loop(double road_m, double beyond_m) {
  RoadWorld world(2);
  world.sigma_seen_m = 0.1;
  world.sigma_heading_rad = 0.001;
  const double radius_m = 4000.0 / (2.0 * core::pi);
  const auto at = [&](double s, double off_m) -> Eigen::Vector2d {
    if (s < road_m) return {s, off_m};
    const double angle = (s - road_m) / radius_m;
    return {road_m + (radius_m - off_m) * std::sin(angle), radius_m - (radius_m - off_m) * std::cos(angle)};
  };
  for (double s = 4.0; s < road_m + 4000.0; s += 8.0) {
    for (const double side_m : {-6.0, 6.0}) world.add_landmark(at(s, side_m));
  }
  for (double s = 0.0; s <= road_m + 4000.0 + beyond_m; s += 10.0) world.drive_to(at(s, 0.0));
  return world;
}

/// The point at `s` on a circular road of this length, or `off_m` beside it.
inline Eigen::Vector2d on_circle(double length_m, double s, double off_m) {
  const double radius_m = length_m / (2.0 * core::pi);
  const double angle = s / radius_m;
  return {(radius_m - off_m) * std::sin(angle), radius_m - (radius_m - off_m) * std::cos(angle)};
}

/// A circular road, a landmark every 8 m on both sides.
inline RoadWorld circle(double length_m) {
  RoadWorld world(3);
  world.sigma_seen_m = 0.1;
  world.sigma_heading_rad = 0.001;
  for (double s = 4.0; s < length_m - 4.0; s += 8.0) {
    for (const double side_m : {-6.0, 6.0}) world.add_landmark(on_circle(length_m, s, side_m));
  }
  return world;
}

/// Lap 1, 2, … of that road.
inline void drive_lap(RoadWorld& world, double length_m, int lap) {
  for (double s = length_m * (lap - 1); s < length_m * lap; s += 10.0) world.drive_to(on_circle(length_m, s, 0.0));
}

}  // namespace helixnav::bench
