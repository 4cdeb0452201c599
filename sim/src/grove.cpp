// SPDX-License-Identifier: BSD-3-Clause
#include "grove.hpp"

#include <algorithm>

namespace helixnav::sim {
namespace {

constexpr double along_scatter_m = 0.5;

/// `offset_m` to the left of the route (negative: right).
Eigen::Vector2d beside(const Route& route, double along_m, double offset_m, double scatter_m) {
  const Eigen::Vector2d forward = route.direction(along_m);
  return route.at(along_m) + offset_m * Eigen::Vector2d(-forward.y(), forward.x()) + scatter_m * forward;
}

}  // namespace

bool Grove::plant(const Eigen::Vector2d& point_m, const Stretch& present) {
  const bool crowded = std::any_of(trees_.begin(), trees_.end(),
                                   [&](const Tree& tree) { return (tree.point_m - point_m).norm() < nearest_trees_m; });
  if (crowded || route_.distance_m(point_m) < road_clearance_m_) return false;
  trees_.push_back({point_m, present});
  return true;
}

void Grove::plant_along(const Route& road, const Stretch& stretch, const WorldOptions& options, double probability,
                        const Stretch& present, core::RandomStream& random) {
  const Interval& spacing = options.tree_spacing_m;
  for (const double side : {-1.0, 1.0}) {
    double along_m = stretch.from_m + random.uniform(0.0, spacing.min);
    while (along_m < stretch.to_m) {
      const double offset_m = side * random.uniform(options.tree_offset_m.min, options.tree_offset_m.max);
      const double scatter_m = random.normal(0.0, along_scatter_m);
      if (random.bernoulli(probability)) plant(beside(road, along_m, offset_m, scatter_m), present);
      along_m += random.uniform(spacing.min, spacing.max);
    }
  }
}

void Grove::fell(double share, double at_m, core::RandomStream& random) {
  for (Tree& tree : trees_) {
    if (random.bernoulli(share)) tree.present.to_m = at_m;
  }
}

}  // namespace helixnav::sim
