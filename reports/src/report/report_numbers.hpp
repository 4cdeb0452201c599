// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include "helixnav/core/time.hpp"
#include "json.hpp"

namespace helixnav::reports {

constexpr std::size_t most_line_points = 3600;
constexpr std::size_t most_dots = 2400;
constexpr std::size_t most_blocks = 240;

/// Digits that no screen shows waste bytes: lengths to 0.1 mm, times to 1 ms.
inline Json rounded(double value, double unit = 1e-4) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value / unit) * unit == 0.0 ? 0.0 : std::round(value / unit) / std::round(1.0 / unit);
}

inline Json time_of(core::Nanoseconds t_ns) { return rounded(core::seconds(t_ns), 1e-3); }

/// {"name": [value(item) of every stride-th item], …}
template <typename Item>
struct Column {
  const char* name;
  Json (*value)(const Item&);
};

template <typename Item, std::size_t n>
Json columns(const std::vector<Item>& items, std::size_t stride, const Column<Item> (&wanted)[n]) {
  Json json = Json::object();
  for (const Column<Item>& column : wanted) {
    Json& list = json[column.name] = Json::array();
    for (std::size_t i = 0; i < items.size(); i += stride) list.push_back(column.value(items[i]));
  }
  return json;
}

}  // namespace helixnav::reports
