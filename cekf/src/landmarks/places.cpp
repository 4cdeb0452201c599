// SPDX-License-Identifier: BSD-3-Clause
// Which landmark is where: active, passive, or nowhere.
#include <algorithm>
#include <string>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::cekf {

std::vector<CompressedEkf::NamedPlace>::const_iterator CompressedEkf::from_name(core::LandmarkId id) const {
  // std::lower_bound without its branches, which no processor can predict: every landmark look-up uses this.
  auto first = places_.begin();
  auto left = static_cast<std::ptrdiff_t>(places_.size());
  while (left > 1) {
    const std::ptrdiff_t half = left / 2;
    first += half * static_cast<std::ptrdiff_t>(first[half - 1].id < id);
    left -= half;
  }
  return left == 1 && first->id < id ? first + 1 : first;
}

/// Null for a landmark that is not there.
const CompressedEkf::Place* CompressedEkf::find_place(core::LandmarkId id) const {
  const auto found = from_name(id);
  return found != places_.end() && found->id == id ? &found->place : nullptr;
}

/// Of a landmark that is there, or for which there is room.
void CompressedEkf::set_place(core::LandmarkId id, const Place& place) {
  const auto at = places_.begin() + (from_name(id) - places_.begin());
  if (at != places_.end() && at->id == id) {
    at->place = place;
  } else {
    places_.insert(at, {id, place});
  }
}

const CompressedEkf::Place& CompressedEkf::place_of(core::LandmarkId id, const char* verb) const {
  if (id < 0 || id >= active_.next_id) {
    throw core::PreconditionError(std::string(verb) + ": landmark " + std::to_string(id) + " is unknown");
  }
  const Place* place = find_place(id);
  if (place == nullptr) {
    throw core::PreconditionError(std::string(verb) + ": landmark " + std::to_string(id) + " has been removed");
  }
  return *place;
}

/// Allocates nothing where there is room for the passive landmarks of the phase and the active ones.
void CompressedEkf::rebuild_places() {
  places_.clear();
  for (const auto& [id, slot] : phases_.back().passive_slots) places_.push_back({id, {Whereabouts::passive, slot}});
  for (const core::LandmarkId id : active_.left_passive) {
    if (find_place(id) != nullptr) set_place(id, {});
  }
  const auto has_left = [](const NamedPlace& named) { return named.place.where == Whereabouts::nowhere; };
  places_.erase(std::remove_if(places_.begin(), places_.end(), has_left), places_.end());
  for (std::size_t i = 0; i < active_.ids.size(); ++i) {
    places_.push_back({active_.ids[i], {Whereabouts::active, static_cast<int>(i)}});
  }
  std::sort(places_.begin(), places_.end(), [](const NamedPlace& a, const NamedPlace& b) { return a.id < b.id; });
}

bool CompressedEkf::contains(core::LandmarkId id) const { return find_place(id) != nullptr; }

bool CompressedEkf::is_active(core::LandmarkId id) const {
  const Place* place = find_place(id);
  return place != nullptr && place->where == Whereabouts::active;
}

std::vector<core::LandmarkId> CompressedEkf::landmarks() const {
  std::vector<core::LandmarkId> ids;
  ids.reserve(places_.size());
  for (const NamedPlace& named : places_) ids.push_back(named.id);
  return ids;
}

}  // namespace helixnav::cekf
