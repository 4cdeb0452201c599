// SPDX-License-Identifier: BSD-3-Clause
#include "index/parts.hpp"

#include <cmath>
#include <string>

#include "helixnav/core/errors.hpp"

namespace helixnav::relocalize {

namespace {

IndexOptions checked(const IndexOptions& options) {
  const bool lengths = std::isfinite(options.reach_m) && options.pair_noise_m > 0.0;
  if (!lengths || !(options.reach_m >= 20.0 * options.pair_noise_m))
    throw core::PreconditionError("map index: reach " + std::to_string(options.reach_m) + " m and pair noise " +
                                  std::to_string(options.pair_noise_m) +
                                  " m must be positive, the reach at least 20 pair noises");
  return options;
}

constexpr double most_extent_in_noises = 4e5;

}  // namespace

MapIndex::Parts::Parts(const IndexOptions& given)
    : options(checked(given)),
      reach_m(static_cast<float>(given.reach_m)),
      noise_m(static_cast<float>(given.pair_noise_m)),
      grid(8.0F * reach_m, far_pair_m()),
      looked(given.reach_m / 8.0),
      bins(0, reach_m, side_tolerance_m() / 4.0F),
      rarity(reach_m) {}

void MapIndex::Parts::check(const Landmark& landmark) const {
  const auto refuse = [&](const std::string& why) {
    throw core::PreconditionError("map index: landmark " + std::to_string(landmark.id) + ": " + why);
  };
  if (landmark.id < 0) refuse("negative id");
  if (!landmark.point.mean_m.allFinite()) refuse("its position is not finite");
  if (!core::is_symmetric_positive_definite(landmark.point.covariance_m2))
    refuse("its covariance is not symmetric positive definite");
  if (landmark.size && !(std::isfinite(landmark.size->mean_m) && landmark.size->sigma_m > 0.0))
    refuse("its size needs a finite mean and a positive sigma");
  if (!has_room_at(landmark.point.mean_m)) refuse("too far from the first one");
}

bool MapIndex::Parts::has_room_at(const Eigen::Vector2d& point_m) const {
  return !placed || (point_m - origin_m).cwiseAbs().maxCoeff() <= most_extent_in_noises * options.pair_noise_m;
}

void MapIndex::Parts::place_origin(const Eigen::Vector2d& near_m) {
  if (placed) return;
  const double step_m = 32.0 * options.reach_m;  // maps begun at different landmarks of a place share their origin
  origin_m = ((near_m / step_m).array().round() * step_m).matrix();
  placed = true;
}

Slot MapIndex::Parts::add_node(const Landmark& landmark) {
  Node node;
  node.x_m = static_cast<float>(landmark.point.mean_m.x() - origin_m.x());
  node.y_m = static_cast<float>(landmark.point.mean_m.y() - origin_m.y());
  node.near.fill(no_slot);
  const Eigen::Matrix2f covariance = landmark.point.covariance_m2.cast<float>();
  const Detail detail = {landmark.id, covariance(0, 0), covariance(0, 1), covariance(1, 1)};
  Slot slot = free_slot;
  if (slot != no_slot) {
    free_slot = nodes[slot].next;
    nodes[slot] = node;
    details[slot] = detail;
  } else {
    if (nodes.size() == most_slots) throw core::PreconditionError("map index: more than 2^24 landmarks");
    slot = nodes.push_back(node);
    details.push_back(detail);
  }
  Trait trait;
  trait.kind = landmark.kind;
  if (landmark.size) {
    trait.size_m = static_cast<float>(landmark.size->mean_m);
    trait.size_sigma_m = static_cast<float>(landmark.size->sigma_m);
  }
  if (landmark.kind || landmark.size) traits.set(slot, trait);
  appearances.count(landmark, 1);
  slots.set(static_cast<std::size_t>(landmark.id), slot);
  grid.insert(nodes, slot);
  ++count;
  return slot;
}

void MapIndex::Parts::drop_node(Slot slot) {
  grid.erase(nodes, slot);
  const Trait& trait = traits[slot];
  Landmark counted;
  counted.kind = trait.kind;
  if (trait.size_sigma_m > 0.0F) counted.size = Size{trait.size_m, trait.size_sigma_m};
  appearances.count(counted, -1);
  if (trait.kind || trait.size_sigma_m > 0.0F) traits.set(slot, Trait());
  slots.set(static_cast<std::size_t>(details[slot].id), no_slot);
  nodes[slot].next = free_slot;
  free_slot = slot;
  --count;
}

}  // namespace helixnav::relocalize
