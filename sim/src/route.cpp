// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/sim/route.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "helixnav/core/errors.hpp"

namespace helixnav::sim {
namespace {

constexpr double direction_arm_m = 0.5;

}  // namespace

Route::Route(std::vector<Eigen::Vector2d> points_m) : points_m_(std::move(points_m)) {
  if (points_m_.size() < 2) throw core::PreconditionError("Route: needs at least two points");
  along_m_.reserve(points_m_.size());
  along_m_.push_back(0.0);
  for (std::size_t i = 1; i < points_m_.size(); ++i) {
    const double step_m = (points_m_[i] - points_m_[i - 1]).norm();
    if (!(step_m > 0.0)) throw core::PreconditionError("Route: two neighbouring points are equal");
    along_m_.push_back(along_m_.back() + step_m);
  }
}

std::size_t Route::segment_of(double along_m) const {
  const auto after = std::upper_bound(along_m_.begin() + 1, along_m_.end() - 1, along_m);
  return static_cast<std::size_t>(after - along_m_.begin()) - 1;
}

Eigen::Vector2d Route::at(double along_m) const {
  const double clamped_m = std::clamp(along_m, 0.0, length_m());
  const std::size_t i = segment_of(clamped_m);
  const double share = (clamped_m - along_m_[i]) / (along_m_[i + 1] - along_m_[i]);
  return points_m_[i] + share * (points_m_[i + 1] - points_m_[i]);
}

Eigen::Vector2d Route::direction(double along_m) const {
  return (at(along_m + direction_arm_m) - at(along_m - direction_arm_m)).normalized();
}

double Route::nearest_along_m(const Eigen::Vector2d& point_m, const Stretch& stretch) const {
  double best_m = stretch.from_m;
  double best_distance_m2 = std::numeric_limits<double>::infinity();
  const std::size_t last = segment_of(stretch.to_m);
  double beyond_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = segment_of(stretch.from_m); i <= last; ++i) {
    const double length_m = along_m_[i + 1] - along_m_[i];
    const double too_far_m = (points_m_[i] - point_m).norm() - beyond_m;
    if (too_far_m > length_m) {  // and so is everything within that length of road from here
      i = std::max(i, segment_of(along_m_[i] + too_far_m) - 1);
      continue;
    }
    const Eigen::Vector2d forward = (points_m_[i + 1] - points_m_[i]) / length_m;
    const double first_m = std::max(stretch.from_m - along_m_[i], 0.0);
    const double last_m = std::min(stretch.to_m - along_m_[i], length_m);
    const double step_m = std::max(first_m, std::min((point_m - points_m_[i]).dot(forward), last_m));
    const double distance_m2 = (points_m_[i] + step_m * forward - point_m).squaredNorm();
    if (distance_m2 < best_distance_m2) {
      best_distance_m2 = distance_m2;
      beyond_m = std::sqrt(distance_m2) + 1e-6;
      best_m = along_m_[i] + step_m;
    }
  }
  return best_m;
}

double Route::distance_m(const Eigen::Vector2d& point_m) const {
  return (point_m - at(nearest_along_m(point_m, {0.0, length_m()}))).norm();
}

Route route_from_origin(const std::vector<Eigen::Vector2d>& points_m) {
  const Route raw(points_m);
  const Eigen::Vector2d forward = raw.direction(0.0);
  Eigen::Matrix2d R_start_raw;
  R_start_raw << forward.x(), forward.y(), -forward.y(), forward.x();
  std::vector<Eigen::Vector2d> moved_m;
  moved_m.reserve(points_m.size());
  for (const Eigen::Vector2d& point_m : points_m) moved_m.emplace_back(R_start_raw * (point_m - points_m.front()));
  return Route(std::move(moved_m));
}

}  // namespace helixnav::sim
