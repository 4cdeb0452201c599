// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "helixnav/core/appearance.hpp"
#include "run_rows.hpp"

namespace helixnav::runs {

/// Cells of the likeliest class and of the size, each after a comma; empty where they are unknown.
void append_appearance(std::string& text, const core::LandmarkAppearance& known);

/// Reads four cells from here on; RunRow refuses what cannot be a class or a size.
core::LandmarkAppearance read_appearance(const RunRow& row, std::size_t column);

}  // namespace helixnav::runs
