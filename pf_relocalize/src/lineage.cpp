// SPDX-License-Identifier: BSD-3-Clause
#include "lineage.hpp"

#include <algorithm>

namespace helixnav::pf_relocalize {

Lineage::Lineage(std::size_t scans, std::size_t most_particles) : ring_(scans) {
  for (Cloud& cloud : ring_) {
    for (auto* column : {&cloud.x_m, &cloud.y_m, &cloud.heading_rad}) column->reserve(most_particles);
    cloud.parents.reserve(most_particles);
  }
}

void Lineage::append(core::Nanoseconds t_ns, const Particles& particles, const std::vector<std::uint32_t>& parents,
                     std::uint32_t best) {
  Cloud& cloud = ring_[appended_++ % ring_.size()];
  cloud.t_ns = t_ns;
  cloud.x_m = particles.x_m;
  cloud.y_m = particles.y_m;
  cloud.heading_rad = particles.heading_rad;
  cloud.parents = parents;
  best_ = best;
}

std::vector<LineagePose> Lineage::trace() const {
  const std::size_t kept = std::min(appended_, ring_.size());
  std::vector<LineagePose> poses(kept);
  std::uint32_t i = best_;
  for (std::size_t back = 0; back < kept; ++back) {
    const Cloud& cloud = ring_[(appended_ - 1 - back) % ring_.size()];
    poses[kept - 1 - back] = {cloud.t_ns, core::Pose2(cloud.x_m[i], cloud.y_m[i], cloud.heading_rad[i])};
    if (!cloud.parents.empty()) i = cloud.parents[i];
  }
  return poses;
}

}  // namespace helixnav::pf_relocalize
