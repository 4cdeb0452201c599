// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "helixnav/core/decision.hpp"
#include "helixnav/core/joint_map.hpp"
#include "placing/asked.hpp"
#include "placing/place_search.hpp"

namespace helixnav::supervisor {

/// A map whose pose relative to the present one is not known: that of an earlier session, or of a part of the drive
/// before the vehicle was carried.
struct MapApart {
  int part = 0;  ///< of the drive, see core::CarriedDecision
  std::shared_ptr<const core::JointMap> map;
  std::shared_ptr<const PlaceSearch> search = {};  ///< in it, from the first scan on
};

struct PlacingRecord;

/// All such maps, in order of part, and what they were asked: every question goes to each.
struct MapsApart {
  std::vector<MapApart> maps;
  Asked asked;
  int part = 0;  ///< of the drive in which the vehicle is
  int next_part = 1;
  std::int64_t begun_step = 0;                   ///< of the first scan of that part
  std::shared_ptr<const PlacingRecord> placing;  ///< how the vehicle's place was found on another map; null: it was not

  bool any() const { return !maps.empty(); }
};

}  // namespace helixnav::supervisor
