// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/core/step_report.hpp"

namespace helixnav::runs {

/// The text of map.csv.
std::string map_text(const std::vector<core::MapLandmark>& map);

}  // namespace helixnav::runs
