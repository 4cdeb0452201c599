// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace helixnav::logs {

/// [name] the text of logs/vehicles/NAME.toml.
const std::map<std::string, std::string_view>& shipped_vehicle_texts();

}  // namespace helixnav::logs
