// SPDX-License-Identifier: BSD-3-Clause
#include "slip/density_of_new.hpp"

#include <algorithm>

#include "helixnav/core/angle.hpp"

namespace helixnav::supervisor {

double local_density_per_m2(const std::vector<Eigen::Vector2d>& points_m) {
  constexpr std::ptrdiff_t nth = 3;
  if (points_m.size() <= nth) return 0.0;
  std::vector<double> squared_m2;  // of the third neighbours
  for (const Eigen::Vector2d& one : points_m) {
    std::vector<double> to_m2;
    for (const Eigen::Vector2d& other : points_m) to_m2.push_back((other - one).squaredNorm());
    std::nth_element(to_m2.begin(), to_m2.begin() + nth, to_m2.end());  // the first is itself
    squared_m2.push_back(to_m2[nth]);
  }
  const auto middle = squared_m2.begin() + static_cast<std::ptrdiff_t>(squared_m2.size() / 2);
  std::nth_element(squared_m2.begin(), middle, squared_m2.end());
  return static_cast<double>(nth) / (core::pi * *middle);
}

std::vector<double> density_of_new(const std::vector<SeenPoint>& seen, const core::Pose2& T_world_robot,
                                   const pf_relocalize::Coverage& looked_at, double mapped_per_m2,
                                   double extraneous_per_m2) {
  std::vector<double> per_m2;
  for (const SeenPoint& one : seen) {
    const bool was_looked_at = looked_at.covers(core::transform(T_world_robot, one.point_m));
    per_m2.push_back(was_looked_at ? extraneous_per_m2 : std::max(extraneous_per_m2, mapped_per_m2));
  }
  return per_m2;
}

}  // namespace helixnav::supervisor
