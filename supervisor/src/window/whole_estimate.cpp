// SPDX-License-Identifier: BSD-3-Clause
// Questions about the whole map, of which the filter may hold a part.
#include <algorithm>
#include <vector>

#include "loop/navigation_loop.hpp"
#include "window/marginals.hpp"

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

/// Of landmarks(), from the atlas, brought up to now.
std::vector<core::PointGaussian> NavigationLoop::marginals() const {
  return marginals_of(drive_until_now()->atlas(), landmarks());
}

/// From the filter where it holds them all, else from the atlas, brought up to now.
core::JointGaussian NavigationLoop::joint(const std::vector<core::LandmarkId>& ids) const {
  const auto is_held = [&](core::LandmarkId id) { return belief_.filter.contains(id); };
  if (std::all_of(ids.begin(), ids.end(), is_held)) return belief_.filter.joint(ids);
  return drive_until_now()->atlas().joint(ids);
}

}  // namespace helixnav::supervisor
