// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "helixnav/core/landmark_id.hpp"
#include "index/paged.hpp"

namespace helixnav::relocalize {

using Slot = std::uint32_t;  ///< where the index keeps a landmark; used again after removal
inline constexpr Slot no_slot = std::numeric_limits<Slot>::max();
inline constexpr int neighbours = 8;

/// What the search reads of a landmark. Coordinates from the index's origin.
struct Node {
  float x_m = 0.0F;
  float y_m = 0.0F;
  float farthest_m2 = std::numeric_limits<float>::infinity();  ///< to the last of eight neighbours; infinite with fewer
  Slot next = no_slot;                                         ///< in its grid cell, or in the list of free slots
  std::array<Slot, neighbours> near{};  ///< in no order: an entry keeps its neighbour while it is one
};

/// What only refinement and evidence read.
struct Detail {
  core::LandmarkId id = core::no_landmark;
  float xx_m2 = 0.0F;
  float xy_m2 = 0.0F;
  float yy_m2 = 0.0F;
};

using Nodes = Paged<Node, 8>;
using Details = Paged<Detail, 8>;

inline float squared_distance_m2(const Node& a, const Node& b) {
  const float dx = a.x_m - b.x_m;
  const float dy = a.y_m - b.y_m;
  return dx * dx + dy * dy;
}

}  // namespace helixnav::relocalize
