// SPDX-License-Identifier: BSD-3-Clause
#include "moved_landmark.hpp"

#include <algorithm>

#include <Eigen/LU>

#include "helixnav/core/chi2.hpp"

namespace helixnav::team {

void MovedLandmark::refuse(std::size_t robot, const core::PointGaussian& place, const SightingCounts& robots) {
  static const double gate = core::chi2_quantile(0.999, 2);
  const Eigen::Vector2d apart_m = place.mean_m - place_.mean_m;
  const auto agrees = [&] {
    return apart_m.dot((place.covariance_m2 + place_.covariance_m2).inverse() * apart_m) < gate;
  };
  if (in_a_row_ > 0 && !agrees()) in_a_row_ = 0;
  if (in_a_row_ == 0 || robot != robot_) {
    robot_ = robot;
    by_robot_ = 0;
    before_ = {robots.accepted, robots.refused - 1};
  }
  ++in_a_row_;
  ++by_robot_;
  place_ = place;
}

bool MovedLandmark::has_moved(int observed, const SightingCounts& robots) const {
  constexpr int enough = 5;
  if (in_a_row_ < std::max(enough, observed / 4)) return false;
  const std::int64_t others_refused = robots.refused - before_.refused - by_robot_;
  return robots.accepted - before_.accepted > others_refused;
}

}  // namespace helixnav::team
