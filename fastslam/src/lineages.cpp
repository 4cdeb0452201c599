// SPDX-License-Identifier: BSD-3-Clause
#include "lineages.hpp"

#include <algorithm>

namespace helixnav::fastslam {

LineageId Lineages::add(const Eigen::Vector2d& place_m) {
  const auto id = static_cast<LineageId>(lineages_.size());
  lineages_.push_back({static_cast<float>(place_m.x()), static_cast<float>(place_m.y()), 0.0F, none});
  ++living_;
  if (living_ > 2 * buckets_.size()) {
    rebuild(2 * buckets_.size());
  } else {
    enter(id);
  }
  return id;
}

float Lineages::reach_for(double distance_m) {
  constexpr double first_m = 0.25, ratio = 1.25;
  if (distance_m <= first_m) return static_cast<float>(first_m);
  const double steps = std::ceil(std::log(distance_m / first_m) / std::log(ratio) + 1e-6);
  return static_cast<float>(first_m * std::pow(ratio, steps));
}

void Lineages::grow(LineageId id, float reach_m) {
  Lineage& lineage = lineages_[id];
  lineage.reach_m = std::max(lineage.reach_m, reach_m);
  longest_reach_m_ = std::max(longest_reach_m_, static_cast<double>(lineage.reach_m));
}

void Lineages::sweep(const std::vector<bool>& alive) {
  living_ = 0;
  longest_reach_m_ = 0.0;
  for (std::size_t id = 0; id < lineages_.size(); ++id) {
    Lineage& lineage = lineages_[id];
    if (!alive[id]) lineage.reach_m = -1.0F;
    if (lineage.reach_m < 0.0F) continue;
    ++living_;
    longest_reach_m_ = std::max(longest_reach_m_, static_cast<double>(lineage.reach_m));
  }
  rebuild(buckets_.size());
}

void Lineages::rebuild(std::size_t buckets) {
  buckets_.assign(buckets, none);
  for (std::size_t id = 0; id < lineages_.size(); ++id) {
    if (lineages_[id].reach_m >= 0.0F) enter(static_cast<LineageId>(id));
  }
}

void Lineages::enter(LineageId id) {
  Lineage& lineage = lineages_[id];
  std::uint32_t& first = buckets_[bucket(cell(lineage.x_m), cell(lineage.y_m))];
  lineage.next = first;
  first = id;
}

}  // namespace helixnav::fastslam
