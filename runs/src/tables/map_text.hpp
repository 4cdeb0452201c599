// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "helixnav/core/step_report.hpp"

namespace helixnav::runs {

/// The text of map.csv; with a column `name` if there are any. A comma, a quotation mark or a control character in a
/// name becomes a space.
std::string map_text(const std::vector<core::MapLandmark>& map,
                     const std::map<core::LandmarkId, std::string>& names = {});

}  // namespace helixnav::runs
