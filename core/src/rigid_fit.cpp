// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/rigid_fit.hpp"

#include <cmath>

namespace helixnav::core {
namespace {

Eigen::Vector2d mean_of(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

}  // namespace

Pose2 fit_rigidly(const std::vector<Eigen::Vector2d>& points_a, const std::vector<Eigen::Vector2d>& points_b) {
  if (points_a.empty()) return {};
  const Eigen::Vector2d mean_a = mean_of(points_a);
  const Eigen::Vector2d mean_b = mean_of(points_b);
  double cross = 0.0;
  double dot = 0.0;
  for (std::size_t i = 0; i < points_a.size(); ++i) {
    const Eigen::Vector2d a = points_a[i] - mean_a;
    const Eigen::Vector2d b = points_b[i] - mean_b;
    cross += b.x() * a.y() - b.y() * a.x();
    dot += b.dot(a);
  }
  const double heading_rad = std::atan2(cross, dot);
  const Eigen::Vector2d position = mean_a - rotation(heading_rad) * mean_b;
  return {position.x(), position.y(), heading_rad};
}

}  // namespace helixnav::core
