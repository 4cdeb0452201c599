// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "helixnav/relocalize/question.hpp"

namespace helixnav::relocalize {

std::vector<Disc> ground_around(const std::vector<Eigen::Vector2d>& nearest_first_m, double reach_m) {
  constexpr double share_of_eighth = 0.6;  // as MapIndex::look_around_landmarks
  std::vector<Disc> discs;
  if (nearest_first_m.empty()) return discs;
  const Eigen::Vector2d centre_m = nearest_first_m.front();
  const double farthest_m = (nearest_first_m.back() - centre_m).norm();
  for (const Eigen::Vector2d& point_m : nearest_first_m) {
    std::vector<double> others_m;
    for (const Eigen::Vector2d& other_m : nearest_first_m) others_m.push_back((other_m - point_m).norm());
    const auto eighth = others_m.begin() + std::min<std::ptrdiff_t>(8, std::ptrdiff_t(others_m.size()) - 1);
    std::nth_element(others_m.begin(), eighth, others_m.end());
    const double radius_m =
        std::min(share_of_eighth * std::min(*eighth, reach_m), farthest_m - (point_m - centre_m).norm());
    if (radius_m > 0.0) discs.push_back({point_m, radius_m});
  }
  return discs;
}

}  // namespace helixnav::relocalize
