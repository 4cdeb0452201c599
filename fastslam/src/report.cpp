// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>

#include "impl.hpp"

namespace helixnav::fastslam {

/// What the heaviest hypothesis made of the scan; births get their ids later. Innovations are those of `before`, the
/// hypothesis before the scan; taken one after the other, their NIS add up to the joint one.
core::StepReport FastSlam::Impl::report(const core::Scan& scan, const Associator& associator, std::size_t heaviest,
                                        const Hypothesis& before) const {
  core::StepReport out;
  out.step = step;
  out.t_ns = scan.t_ns;
  Hypothesis moving = before;
  for (std::size_t j = 0; j < set.observations; ++j) {
    const Choice choice = set.choices_of(heaviest)[j];
    core::AssociationReport& a = out.associations.emplace_back();
    a.observation = static_cast<int>(j);
    a.nis = a.margin_nats = std::numeric_limits<double>::quiet_NaN();  // alternatives: each particle has its own
    if (choice == begins_landmark) a.outcome = core::Outcome::augmented;
    if (choice < 0) continue;
    const auto id = static_cast<LineageId>(choice);
    a.outcome = core::Outcome::matched;
    a.landmark = choice;
    a.dof = 2;
    a.nis = associator.nis(before, id, j);
    const double added_nis = associator.nis(moving, id, j);
    if (!std::isnan(added_nis)) {
      out.joint_nis += added_nis;
      out.joint_dof += a.dof;
    }
    associator.take(moving, {id, static_cast<std::uint32_t>(j), 0.0, 0.0}, true);
  }
  return out;
}

std::vector<core::MapLandmark> FastSlam::Impl::map_of(std::size_t particle) const {
  std::vector<core::MapLandmark> map;
  maps[particle].for_each([&](LineageId id, const LandmarkRecord& landmark) {
    core::MapLandmark& out = map.emplace_back();
    out.id = static_cast<core::LandmarkId>(id);
    out.point.mean_m = lineages.anchor_m(id) + Eigen::Vector2d(landmark.dx_m, landmark.dy_m);
    out.point.covariance_m2 = landmark.covariance_m2().matrix();
    out.observations = landmark.hits;
    out.state = landmark.mature != 0 ? core::LandmarkState::mature : core::LandmarkState::tentative;
  });
  return map;
}

std::size_t FastSlam::Impl::node_bytes() const {
  std::ptrdiff_t live = 0;
  for (const Worker& worker : workers) live += worker.pool.live_bytes();
  return static_cast<std::size_t>(live);
}

MemoryReport FastSlam::Impl::memory() const {
  MemoryReport out;
  out.nodes = node_bytes();
  out.most_nodes = most_node_bytes;
  out.lineages = lineages.bytes();
  for (const Worker& worker : workers) out.reserved += worker.pool.reserved_bytes();
  out.landmarks = lineages.living();
  return out;
}

}  // namespace helixnav::fastslam
