// SPDX-License-Identifier: BSD-3-Clause
// Which landmark is where: active, passive, or nowhere.
#include <string>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::cekf {

const CompressedEkf::Place& CompressedEkf::place_of(core::LandmarkId id, const char* verb) const {
  if (id < 0 || id >= active_.next_id) {
    throw core::PreconditionError(std::string(verb) + ": landmark " + std::to_string(id) + " is unknown");
  }
  const Place& place = places_[static_cast<std::size_t>(id)];
  if (place.where == Whereabouts::nowhere) {
    throw core::PreconditionError(std::string(verb) + ": landmark " + std::to_string(id) + " has been removed");
  }
  return place;
}

void CompressedEkf::rebuild_places() {
  const Phase& phase = phases_.back();
  places_.assign(static_cast<std::size_t>(active_.next_id), {});
  for (std::size_t id = 0; id < phase.slot_of_id.size(); ++id) {
    if (phase.slot_of_id[id] >= 0) places_[id] = {Whereabouts::passive, phase.slot_of_id[id]};
  }
  for (const core::LandmarkId id : active_.left_passive) places_[static_cast<std::size_t>(id)] = {};
  for (std::size_t i = 0; i < active_.ids.size(); ++i) {
    places_[static_cast<std::size_t>(active_.ids[i])] = {Whereabouts::active, static_cast<int>(i)};
  }
  mapped_ = 0;
  for (const Place& place : places_) mapped_ += place.where != Whereabouts::nowhere;
}

bool CompressedEkf::contains(core::LandmarkId id) const {
  return id >= 0 && id < active_.next_id && places_[static_cast<std::size_t>(id)].where != Whereabouts::nowhere;
}

bool CompressedEkf::is_active(core::LandmarkId id) const {
  return contains(id) && places_[static_cast<std::size_t>(id)].where == Whereabouts::active;
}

std::vector<core::LandmarkId> CompressedEkf::landmarks() const {
  std::vector<core::LandmarkId> ids;
  ids.reserve(static_cast<std::size_t>(mapped_));
  for (core::LandmarkId id = 0; id < active_.next_id; ++id) {
    if (contains(id)) ids.push_back(id);
  }
  return ids;
}

}  // namespace helixnav::cekf
