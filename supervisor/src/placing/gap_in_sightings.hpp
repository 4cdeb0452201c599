// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "helixnav/association/landmark_life.hpp"

namespace helixnav::supervisor {

/// Where on the drive the landmarks seen before it are no longer seen: there the vehicle may have been carried without being told.
struct SightingGap {
  double first_m = 0.0;  ///< length of the drive where the first landmark after it was begun
  double last_m = 0.0;   ///< likewise of the last gap, which is the same one unless several are as good
  int across = 0;        ///< landmarks begun before it and seen after it
  int since = 0;         ///< landmarks seen at `last_m` or later
};

/// The gaps with the fewest landmarks across them, each ended by a landmark begun at a length in (from_m, until_m]; nothing if none was
/// begun there. It is read from the records of existence, so the drive need not be kept. Cost O(n log n).
/// Test: supervisor/placing/gap_in_sightings_test.cpp.
std::optional<SightingGap> gap_in_sightings(const association::LandmarkLife& existence, double from_m, double until_m);

}  // namespace helixnav::supervisor
