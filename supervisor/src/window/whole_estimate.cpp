// SPDX-License-Identifier: BSD-3-Clause
// Questions about the whole map, of which the filter may hold a part.
#include <algorithm>
#include <vector>

#include "loop/navigation_loop.hpp"

namespace helixnav::supervisor {

std::vector<core::LandmarkId> NavigationLoop::landmarks() const {
  if (!belief_.drive) return belief_.filter.landmarks();
  std::vector<core::LandmarkId> ids;
  for (const association::LandmarkRecord& record : belief_.existence.records()) ids.push_back(record.id);
  return ids;
}

core::PointGaussian NavigationLoop::sketched(core::LandmarkId id) const {
  return belief_.filter.contains(id) ? belief_.filter.landmark(id) : belief_.drive->remembered(id);
}

/// Of landmarks(), from the atlas, brought up to now. Landmarks named one after another are near each other, mostly, and share
/// their paths.
std::vector<core::PointGaussian> NavigationLoop::marginals() const {
  constexpr std::size_t at_once = 50;
  const std::shared_ptr<DriveMap> drive = drive_until_now();
  const std::vector<core::LandmarkId> ids = landmarks();
  std::vector<core::PointGaussian> points;
  for (std::size_t begin = 0; begin < ids.size(); begin += at_once) {
    const auto from = ids.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto to = ids.begin() + static_cast<std::ptrdiff_t>(std::min(begin + at_once, ids.size()));
    const core::JointGaussian joint = drive->atlas().joint({from, to});
    for (std::size_t i = 0; i < joint.ids.size(); ++i) {
      const Eigen::Index row = 3 + 2 * static_cast<Eigen::Index>(i);
      points.push_back({joint.points_m[i], joint.covariance.block<2, 2>(row, row)});
    }
  }
  return points;
}

/// From the filter where it holds them all, else from the atlas, brought up to now.
core::JointGaussian NavigationLoop::joint(const std::vector<core::LandmarkId>& ids) const {
  const auto is_held = [&](core::LandmarkId id) { return belief_.filter.contains(id); };
  if (std::all_of(ids.begin(), ids.end(), is_held)) return belief_.filter.joint(ids);
  return drive_until_now()->atlas().joint(ids);
}

}  // namespace helixnav::supervisor
