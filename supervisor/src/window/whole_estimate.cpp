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

/// What the filter does not hold as it was remembered when the filter left it out.
std::vector<core::PointGaussian> NavigationLoop::sketched(const std::vector<core::LandmarkId>& ids) const {
  std::vector<core::LandmarkId> held;
  for (const core::LandmarkId id : ids) {
    if (belief_.filter.contains(id)) held.push_back(id);
  }
  const std::vector<core::PointGaussian> from_filter = belief_.filter.marginals(held);
  if (held.size() == ids.size()) return from_filter;
  std::vector<core::PointGaussian> points;
  points.reserve(ids.size());
  auto next = held.begin();
  for (const core::LandmarkId id : ids) {
    const bool is_held = next != held.end() && *next == id;
    points.push_back(is_held ? from_filter[static_cast<std::size_t>(next++ - held.begin())]
                             : belief_.drive->remembered(id));
  }
  return points;
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
