// SPDX-License-Identifier: BSD-3-Clause
#include "search/old_ground.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "closing/relative_variance.hpp"

namespace helixnav::supervisor {
namespace {

Eigen::Index row_of(std::size_t landmark) { return 3 + 2 * static_cast<Eigen::Index>(landmark); }

/// The vehicle may see it: it is known relative to the vehicle, and not too far.
bool may_be_in_view(const core::JointGaussian& joint, std::size_t i, double range_m) {
  const double sigma_m = std::sqrt(std::max(0.0, relative_variance_m2(joint.covariance, row_of(i), 0)));
  return (joint.points_m[i] - joint.pose.position_m()).norm() <= range_m + 2.0 * sigma_m;
}

}  // namespace

core::JointGaussian old_ground(const core::JointGaussian& joint, double range_m) {
  std::vector<Eigen::Index> in_view;
  for (std::size_t i = 0; i < joint.points_m.size(); ++i) {
    if (may_be_in_view(joint, i, range_m)) in_view.push_back(row_of(i));
  }
  if (in_view.empty()) return joint;
  core::JointGaussian ground;
  ground.pose = joint.pose;
  std::vector<int> rows{0, 1, 2};
  for (std::size_t i = 0; i < joint.points_m.size(); ++i) {
    const Eigen::Index row = row_of(i);
    const double from_vehicle_m2 = relative_variance_m2(joint.covariance, row, 0);
    const bool belongs = std::any_of(in_view.begin(), in_view.end(), [&](Eigen::Index seen) {
      return relative_variance_m2(joint.covariance, row, seen) <= from_vehicle_m2;
    });
    if (!belongs) continue;
    ground.ids.push_back(joint.ids[i]);
    ground.points_m.push_back(joint.points_m[i]);
    rows.insert(rows.end(), {static_cast<int>(row), static_cast<int>(row) + 1});
  }
  ground.covariance = joint.covariance(rows, rows);
  return ground;
}

}  // namespace helixnav::supervisor
