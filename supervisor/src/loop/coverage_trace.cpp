// SPDX-License-Identifier: BSD-3-Clause
#include "loop/coverage_trace.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "helixnav/core/angle.hpp"

namespace helixnav::supervisor {
namespace {

/// Poses in square cells.
class Seen {
 public:
  explicit Seen(double near_m) : near_m_(near_m) {}

  void add(const core::Pose2& pose) { cells_[cell_of(pose, 0, 0)].push_back(pose); }

  bool has_near(const core::Pose2& pose) const {
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const auto cell = cells_.find(cell_of(pose, dx, dy));
        if (cell == cells_.end()) continue;
        const auto near = [&](const core::Pose2& other) { return is_near(pose, other); };
        if (std::any_of(cell->second.begin(), cell->second.end(), near)) return true;
      }
    }
    return false;
  }

 private:
  using Cell = std::pair<double, double>;

  Cell cell_of(const core::Pose2& pose, int dx, int dy) const {
    return {std::floor(pose.x_m / near_m_) + dx, std::floor(pose.y_m / near_m_) + dy};
  }

  bool is_near(const core::Pose2& a, const core::Pose2& b) const {
    constexpr double turned_rad = 0.3;
    return (a.position_m() - b.position_m()).norm() < near_m_ &&
           std::abs(core::wrap_to_pi(a.heading_rad - b.heading_rad)) < turned_rad;
  }

  double near_m_;
  std::map<Cell, std::vector<core::Pose2>> cells_;
};

}  // namespace

void CoverageTrace::pass(double path_m, const core::Pose2& T_world_sensor) {
  if (!points_.empty() && path_m - points_.back().path_m < spacing_m_) return;
  points_.push_back({path_m, T_world_sensor});
}

void CoverageTrace::back_to(double path_m) {
  while (!points_.empty() && points_.back().path_m > path_m) points_.pop_back();
}

void CoverageTrace::begin_after(double path_m) {
  const auto is_before = [&](const Point& point) { return point.path_m <= path_m; };
  points_.erase(std::remove_if(points_.begin(), points_.end(), is_before), points_.end());
}

void CoverageTrace::thin_before(double path_m, const std::function<bool(double)>& needed) {
  if (points_.size() < thin_from_) return;
  std::vector<Point> kept;
  kept.reserve(points_.size());
  constexpr double near = 0.75;  // of the spacing: neighbours on a curve stay, and one lap is near the other
  Seen seen(near * spacing_m_);
  for (const Point& point : points_) {
    const bool old = point.path_m < path_m;
    if (old && !needed(point.path_m) && seen.has_near(point.T_world_sensor)) continue;
    if (old) seen.add(point.T_world_sensor);
    kept.push_back(point);
  }
  kept.shrink_to_fit();
  points_.swap(kept);
  thin_from_ = std::max(thin_from_, 2 * points_.size());
}

void CoverageTrace::change_frame(const core::Pose2& T_new_old) {
  for (Point& point : points_) point.T_world_sensor = core::compose(T_new_old, point.T_world_sensor);
}

std::vector<core::Pose2> CoverageTrace::between(double from_m, double to_m) const {
  std::vector<core::Pose2> poses;
  for (const Point& point : points_) {
    if (point.path_m >= from_m && point.path_m < to_m) poses.push_back(point.T_world_sensor);
  }
  return poses;
}

}  // namespace helixnav::supervisor
