// SPDX-License-Identifier: BSD-3-Clause
#include "rigid_fit.hpp"

#include <cmath>
#include <limits>

namespace helixnav::evaluation {

core::Pose2 rigid_fit(const std::vector<PlacedTwice>& points) {
  if (points.empty()) return {};
  Eigen::Vector2d map_centre_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d true_centre_m = Eigen::Vector2d::Zero();
  for (const PlacedTwice& point : points) {
    map_centre_m += point.map_m / static_cast<double>(points.size());
    true_centre_m += point.true_m / static_cast<double>(points.size());
  }
  double cross = 0.0;
  double dot = 0.0;
  for (const PlacedTwice& point : points) {
    const Eigen::Vector2d m = point.map_m - map_centre_m;
    const Eigen::Vector2d t = point.true_m - true_centre_m;
    cross += m.x() * t.y() - m.y() * t.x();
    dot += m.dot(t);
  }
  const double heading_rad = std::atan2(cross, dot);
  const Eigen::Vector2d shift_m = true_centre_m - core::rotation(heading_rad) * map_centre_m;
  return {shift_m.x(), shift_m.y(), heading_rad};
}

double rms_after_fit(const std::vector<PlacedTwice>& points) {
  if (points.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const core::Pose2 T_true_map = rigid_fit(points);
  double sum_m2 = 0.0;
  for (const PlacedTwice& point : points) {
    sum_m2 += (core::transform(T_true_map, point.map_m) - point.true_m).squaredNorm();
  }
  return std::sqrt(sum_m2 / static_cast<double>(points.size()));
}

}  // namespace helixnav::evaluation
