// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/relocalize/map_index.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "helixnav/core/errors.hpp"
#include "index/parts.hpp"

namespace helixnav::relocalize {

namespace {

[[noreturn]] void refuse(core::LandmarkId id, const char* why) {
  throw core::PreconditionError("map index: landmark " + std::to_string(id) + why);
}

void shrink_tiles_when_crowded(MapIndex::Parts& parts) {
  if (!parts.grid.crowded()) return;
  TileGrid finer = parts.grid.finer();
  // Slots that are free are in no list of neighbours and in no cell: only those in use have their id's slot.
  for (std::size_t slot = 0; slot < parts.nodes.size(); ++slot)
    if (parts.slot_of(parts.details[slot].id) == slot) finer.insert(parts.nodes, static_cast<Slot>(slot));
  parts.grid = std::move(finer);
}

}  // namespace

MapIndex::MapIndex(const IndexOptions& options) : parts_(std::make_unique<Parts>(options)) {}
MapIndex::MapIndex(const MapIndex& other) : parts_(std::make_unique<Parts>(*other.parts_)) {}
MapIndex& MapIndex::operator=(const MapIndex& other) { return *this = MapIndex(other); }
MapIndex::MapIndex(MapIndex&&) noexcept = default;
MapIndex& MapIndex::operator=(MapIndex&&) noexcept = default;
MapIndex::~MapIndex() = default;

MapIndex::MapIndex(const IndexOptions& options, const std::vector<Landmark>& landmarks) : MapIndex(options) {
  Parts& parts = *parts_;
  // Neighbours in the plane become neighbours in memory: strips of the reach's width, along each in cells of that size.
  std::vector<std::array<std::int64_t, 4>> order;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    parts.place_origin(landmarks[i].point.mean_m);
    parts.check(landmarks[i]);
    const Eigen::Vector2d cell = ((landmarks[i].point.mean_m - parts.origin_m) / options.reach_m).array().floor();
    const auto column = static_cast<std::int64_t>(cell.x());
    const auto row = static_cast<std::int64_t>(cell.y());
    order.push_back({row >> 3, column, row, static_cast<std::int64_t>(i)});
  }
  std::sort(order.begin(), order.end());
  for (const auto& entry : order) {
    const Landmark& landmark = landmarks[static_cast<std::size_t>(entry[3])];
    if (contains(landmark.id)) refuse(landmark.id, " is there twice");
    parts.add_node(landmark);
    shrink_tiles_when_crowded(parts);
  }
  parts.store_all_triangles();
}

bool MapIndex::has_room_at(const Eigen::Vector2d& point_m) const { return parts_->has_room_at(point_m); }

void MapIndex::insert(const Landmark& landmark) {
  parts_->check(landmark);
  if (contains(landmark.id)) refuse(landmark.id, " is there already");
  parts_->place_origin(landmark.point.mean_m);
  const Slot slot = parts_->add_node(landmark);
  parts_->link(slot);
  shrink_tiles_when_crowded(*parts_);
  if (parts_->bins.outgrown()) parts_->refit();
}

void MapIndex::erase(core::LandmarkId id) {
  if (!contains(id)) refuse(id, " is not in the index");
  const Slot slot = parts_->slot_of(id);
  parts_->unlink(slot);
  parts_->drop_node(slot);
}

void MapIndex::move(const Landmark& landmark) {
  parts_->check(landmark);
  erase(landmark.id);
  insert(landmark);
}

void MapIndex::look_at(const Disc& ground) {
  if (!ground.centre_m.allFinite() || !(ground.radius_m >= 0.0) || !std::isfinite(ground.radius_m))
    throw core::PreconditionError("map index: looked-at ground needs a finite centre and a radius of at least 0");
  parts_->place_origin(ground.centre_m);
  const Eigen::Vector2d centre_m = ground.centre_m - parts_->origin_m;
  parts_->looked.mark(centre_m.x(), centre_m.y(), ground.radius_m);
}

void MapIndex::look_around_landmarks() {
  const Parts& parts = *parts_;
  for (std::size_t slot = 0; slot < parts.nodes.size(); ++slot) {
    const Node& node = parts.nodes[slot];
    if (parts.slot_of(parts.details[slot].id) != slot) continue;
    const double eighth_m = std::sqrt(std::min(node.farthest_m2, parts.reach_m * parts.reach_m));
    parts_->looked.mark(node.x_m, node.y_m, 0.6 * eighth_m);
  }
}

const IndexOptions& MapIndex::options() const { return parts_->options; }
std::size_t MapIndex::size() const { return parts_->count; }
bool MapIndex::contains(core::LandmarkId id) const { return parts_->slot_of(id) != no_slot; }
double MapIndex::looked_at_m2() const { return parts_->looked.area_m2(); }
bool MapIndex::has_looked_at(const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d at_m = point_m - parts_->origin_m;
  return at_m.allFinite() && parts_->looked.covers(at_m.x(), at_m.y());
}
std::size_t MapIndex::triangles() const { return parts_->bins.size(); }

std::size_t MapIndex::memory_bytes() const {
  const Parts& p = *parts_;
  return sizeof(Parts) + p.nodes.memory_bytes() + p.details.memory_bytes() + p.slots.memory_bytes() +
         p.traits.memory_bytes() + p.grid.memory_bytes() + p.looked.memory_bytes() + p.bins.memory_bytes() +
         p.rarity.memory_bytes();
}

std::vector<std::array<core::LandmarkId, 3>> MapIndex::list_triangles() const {
  std::vector<std::array<core::LandmarkId, 3>> list;
  parts_->bins.all([&](const Code* codes, std::uint32_t count) {
    for (std::uint32_t k = 0; k < count; ++k) {
      const Corners corners = corners_of(parts_->nodes, codes[k]);
      std::array<core::LandmarkId, 3> ids{};
      for (std::size_t c = 0; c < 3; ++c) ids[c] = parts_->details[corners[c]].id;
      std::sort(ids.begin(), ids.end());
      list.push_back(ids);
    }
  });
  std::sort(list.begin(), list.end());
  return list;
}

}  // namespace helixnav::relocalize
