// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/map_appearance.hpp"

#include <algorithm>

namespace helixnav::core {

const LandmarkAppearance* MapAppearance::find(LandmarkId id) const {
  const auto at = std::lower_bound(landmarks_.begin(), landmarks_.end(), id,
                                   [](const Entry& one, LandmarkId other) { return one.first < other; });
  return at != landmarks_.end() && at->first == id ? &at->second : nullptr;
}

LandmarkAppearance& MapAppearance::entry(LandmarkId id) {
  const auto at = std::lower_bound(landmarks_.begin(), landmarks_.end(), id,
                                   [](const Entry& one, LandmarkId other) { return one.first < other; });
  if (at != landmarks_.end() && at->first == id) return at->second;
  return landmarks_.insert(at, {id, {}})->second;
}

void MapAppearance::see(LandmarkId id, const Appearance& seen) {
  if (!seen.is_given()) return;
  LandmarkAppearance& known = entry(id);
  population_.learn_size_noise(known, seen);
  known = population_.updated(known, seen);
}

void MapAppearance::adopt(LandmarkId id, const LandmarkAppearance& known) {
  if (!known.is_given()) return;
  entry(id) = known;
  Appearance one;
  one.name = known.votes.front().name;
  one.size_m = known.size_m;
  population_.count(one);
}

void MapAppearance::merge(LandmarkId kept, LandmarkId removed) {
  const LandmarkAppearance* gone = find(removed);
  if (gone == nullptr) return;
  const LandmarkAppearance was = *gone;
  LandmarkAppearance& known = entry(kept);
  known = fused(known, was);
  remove(removed);
}

void MapAppearance::remove(LandmarkId id) {
  const LandmarkAppearance* gone = find(id);
  if (gone == nullptr) return;
  const auto same = [&](const Entry& one) { return &one.second == gone; };
  landmarks_.erase(std::find_if(landmarks_.begin(), landmarks_.end(), same));
}

LandmarkAppearance MapAppearance::of(LandmarkId id) const {
  const LandmarkAppearance* known = find(id);
  return known == nullptr ? LandmarkAppearance() : *known;
}

AppearanceEvidence MapAppearance::compare(LandmarkId id, const Appearance& seen) const {
  if (!seen.is_given()) return {};
  const LandmarkAppearance* known = find(id);
  return known == nullptr ? AppearanceEvidence() : population_.compare(*known, seen);
}

bool MapAppearance::look_alike(LandmarkId one, LandmarkId other) const {
  const LandmarkAppearance* first = find(one);
  const LandmarkAppearance* second = find(other);
  return first == nullptr || second == nullptr || population_.look_alike(*first, *second);
}

}  // namespace helixnav::core
