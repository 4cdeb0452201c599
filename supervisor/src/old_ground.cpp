// SPDX-License-Identifier: BSD-3-Clause
#include "old_ground.hpp"

#include <vector>

namespace helixnav::supervisor {
namespace {

/// tr Cov of the difference of two points whose coordinates stand in rows i and j of the joint state.
double relative_variance_m2(const Eigen::MatrixXd& P, Eigen::Index i, Eigen::Index j) {
  return P.block<2, 2>(i, i).trace() + P.block<2, 2>(j, j).trace() - 2.0 * P.block<2, 2>(i, j).trace();
}

Eigen::Index row_of(std::size_t landmark) { return 3 + 2 * static_cast<Eigen::Index>(landmark); }

/// The landmark that the vehicle knows least about, of those within view_m.
std::size_t least_known(const core::JointGaussian& joint, double view_m) {
  std::size_t found = 0;
  bool found_in_view = false;
  double most_m2 = -1.0;
  for (std::size_t i = 0; i < joint.points_m.size(); ++i) {
    const bool in_view = (joint.points_m[i] - joint.pose.position_m()).norm() <= view_m;
    const double variance_m2 = relative_variance_m2(joint.covariance, row_of(i), 0);
    if (in_view < found_in_view || (in_view == found_in_view && variance_m2 <= most_m2)) continue;
    found = i;
    found_in_view = in_view;
    most_m2 = variance_m2;
  }
  return found;
}

}  // namespace

core::JointGaussian old_ground(const core::JointGaussian& joint, double view_m) {
  if (joint.points_m.empty()) return joint;
  const Eigen::Index seed = row_of(least_known(joint, view_m));
  core::JointGaussian ground;
  ground.pose = joint.pose;
  std::vector<int> rows{0, 1, 2};
  for (std::size_t i = 0; i < joint.points_m.size(); ++i) {
    const Eigen::Index row = row_of(i);
    const double from_seed_m2 = relative_variance_m2(joint.covariance, row, seed);
    if (from_seed_m2 > relative_variance_m2(joint.covariance, row, 0)) continue;
    ground.ids.push_back(joint.ids[i]);
    ground.points_m.push_back(joint.points_m[i]);
    rows.insert(rows.end(), {static_cast<int>(row), static_cast<int>(row) + 1});
  }
  ground.covariance = joint.covariance(rows, rows);
  return ground;
}

}  // namespace helixnav::supervisor
