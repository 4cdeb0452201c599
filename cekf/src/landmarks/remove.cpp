// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/cekf/compressed_ekf.hpp"
#include "matrices/make_room.hpp"

namespace helixnav::cekf {

void CompressedEkf::remove(core::LandmarkId id) {
  const Place place = place_of(id, "remove");
  make_room(active_.left_passive, 1);
  make_room(active_.dead_slots, 1);
  if (place.where == Whereabouts::passive) {
    active_.left_passive.push_back(id);
    active_.dead_slots.push_back(place.index);
  } else {
    remove_active(place.index);
  }
  places_.erase(from_name(id));
}

/// The last active landmark takes the place of the removed one. Its weights stay: they are history of the passive part.
void CompressedEkf::remove_active(int index) {
  const std::size_t i = static_cast<std::size_t>(index);
  const int last = active_count() - 1;
  if (active_.slots[i] >= 0) active_.dead_slots.push_back(active_.slots[i]);
  if (index != last) {
    const int to = ActivePart::column(index);
    const int from = ActivePart::column(last);
    auto P = active_.P.view();
    P.middleCols<2>(to) = P.middleCols<2>(from);
    P.middleRows<2>(to) = P.middleRows<2>(from);
    active_.A.view().middleCols<2>(to) = active_.A.view().middleCols<2>(from);
    active_.ids[i] = active_.ids.back();
    active_.slots[i] = active_.slots.back();
    active_.points_m[i] = active_.points_m.back();
    set_place(active_.ids[i], {Whereabouts::active, index});
  }
  active_.ids.pop_back();
  active_.slots.pop_back();
  active_.points_m.pop_back();
  const int n = active_.dimension();
  active_.P.resize(n, n);
  active_.A.resize(active_.weights(), n);
}

}  // namespace helixnav::cekf
