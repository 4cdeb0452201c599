// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "index/node.hpp"

namespace helixnav::relocalize {

/// Sides of a triangle from its longest on, counter-clockwise.
using Sides = std::array<float, 3>;

/// A triangle as a turn of the three points it is asked about: corner k is point order[k].
struct Canonical {
  Sides sides_m{};
  std::array<int, 3> order{};
};

/// Orientation and start of a triangle of points; none when a side is shorter than `least_m` or the height above the
/// longest side is less than 0.8 of that: noise would decide the orientation of such a triangle.
template <class Point>
std::optional<Canonical> canonical(const Point& a, const Point& b, const Point& c, float least_m) {
  const auto squared = [](const Point& p, const Point& q) {
    const float dx = p.x_m - q.x_m;
    const float dy = p.y_m - q.y_m;
    return dx * dx + dy * dy;
  };
  const float twice_area = (b.x_m - a.x_m) * (c.y_m - a.y_m) - (b.y_m - a.y_m) * (c.x_m - a.x_m);
  Sides sides = {squared(a, b), squared(b, c), squared(c, a)};
  std::array<int, 3> order = {0, 1, 2};
  if (twice_area < 0.0F) {
    std::swap(order[1], order[2]);
    std::swap(sides[0], sides[2]);
  }
  const int start = sides[0] >= sides[1] && sides[0] >= sides[2] ? 0 : (sides[1] >= sides[2] ? 1 : 2);
  const auto at = [start](int k) { return static_cast<std::size_t>((start + k) % 3); };
  const float longest_m = std::sqrt(sides[at(0)]);
  const float least_m2 = least_m * least_m;
  if (sides[at(1)] < least_m2 || sides[at(2)] < least_m2) return std::nullopt;
  if (std::abs(twice_area) < 0.8F * longest_m * least_m) return std::nullopt;
  return Canonical{{longest_m, std::sqrt(sides[at(1)]), std::sqrt(sides[at(2)])},
                   {order[at(0)], order[at(1)], order[at(2)]}};
}

/// A triangle of the map in 32 bits: the landmark that owns it, which two of its neighbours, and how they are turned.
using Code = std::uint32_t;
inline constexpr std::size_t most_slots = std::size_t{1} << 24U;

/// Corners of a triangle, in canonical order.
using Corners = std::array<Slot, 3>;

/// Code of {owner, its neighbours at places i < j}, whose corner k is order[k] of these three.
Code encode(Slot owner, int i, int j, const std::array<int, 3>& order);

/// What a code's lower byte holds: places among the neighbours, and which of (owner, i, j) each corner is.
struct Decoded {
  std::uint8_t i, j;
  std::array<std::uint8_t, 3> order;
};
extern const std::array<Decoded, 256> decoded;

inline Slot owner_of(Code code) { return code >> 8U; }

inline Corners corners_of(const Nodes& nodes, Code code) {
  const Decoded& how = decoded[code & 0xFFU];
  const Node& owner = nodes[owner_of(code)];
  const std::array<Slot, 3> points = {owner_of(code), owner.near[how.i], owner.near[how.j]};
  return {points[how.order[0]], points[how.order[1]], points[how.order[2]]};
}

/// Place of `other` among the neighbours of `slot`, −1 if it is not one.
inline int place_among(const Nodes& nodes, Slot slot, Slot other) {
  const auto& near = nodes[slot].near;
  for (int k = 0; k < neighbours; ++k)
    if (near[static_cast<std::size_t>(k)] == other) return k;
  return -1;
}

/// A triangle the index holds: a corner that has both others among its neighbours owns it, the least slot of such corners.
struct Stored {
  Code code = 0;
  Sides sides_m{};
};

/// None when no corner has both others as neighbours, or the shape is refused.
std::optional<Stored> stored(const Nodes& nodes, std::array<Slot, 3> corners, float least_m);

}  // namespace helixnav::relocalize
