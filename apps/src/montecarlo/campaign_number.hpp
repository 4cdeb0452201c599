// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include <nlohmann/json.hpp>

namespace helixnav::apps {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// The number under a key; NaN when it is missing or null.
inline double number(const nlohmann::ordered_json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number() ? found->get<double>() : no_number;
}

}  // namespace helixnav::apps
