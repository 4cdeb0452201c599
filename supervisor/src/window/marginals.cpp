// SPDX-License-Identifier: BSD-3-Clause
#include "window/marginals.hpp"

#include <algorithm>
#include <cstddef>

namespace helixnav::supervisor {

std::vector<core::PointGaussian> marginals_of(const atlas::Atlas& atlas, const std::vector<core::LandmarkId>& ids) {
  constexpr std::size_t at_once = 50;
  std::vector<core::PointGaussian> points;
  for (std::size_t begin = 0; begin < ids.size(); begin += at_once) {
    const auto from = ids.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto to = ids.begin() + static_cast<std::ptrdiff_t>(std::min(begin + at_once, ids.size()));
    const core::JointGaussian joint = atlas.joint({from, to});
    for (std::size_t i = 0; i < joint.ids.size(); ++i) {
      const Eigen::Index row = 3 + 2 * static_cast<Eigen::Index>(i);
      points.push_back({joint.points_m[i], joint.covariance.block<2, 2>(row, row)});
    }
  }
  return points;
}

}  // namespace helixnav::supervisor
