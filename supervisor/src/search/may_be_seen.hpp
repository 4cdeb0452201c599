// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Geometry>

#include "helixnav/pf_relocalize/constellation.hpp"

namespace helixnav::supervisor {

/// Where any of the branch may be, and what sees it: all that the coverage of the old drive is asked about.
/// Conservative: a box around the hypotheses. Test: supervisor/search/may_be_seen_test.cpp (against all views).
class MayBeSeen {
 public:
  MayBeSeen(const std::vector<pf_relocalize::BranchLandmark>& branch, double view_m) {
    double radius_m = 0.0;
    for (const pf_relocalize::BranchLandmark& one : branch) radius_m = std::max(radius_m, one.point_robot_m.norm());
    constexpr double rounding = 1e-6;
    reach_m_ = (1.0 + rounding) * (radius_m + view_m);
  }

  /// Another possible position of the vehicle, in the frame of the views.
  void add(const Eigen::Vector2d& vehicle_m) { box_.extend(vehicle_m); }

  bool seen_from(const Eigen::Vector2d& sensor_m) const {
    return !box_.isEmpty() && box_.squaredExteriorDistance(sensor_m) <= reach_m_ * reach_m_;
  }

 private:
  Eigen::AlignedBox2d box_;
  double reach_m_ = 0.0;
};

}  // namespace helixnav::supervisor
