// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// When poses were given at a wrong place of an earlier map, and how far off; empty if none was found out to be wrong.
/// Test: reports/wrong_place_text_test.cpp.
std::string wrong_place_text(const runs::Run& run);

/// The part was placed again; nobody carried the vehicle.
bool is_wrong_place(const core::Decision& decision);

/// The vehicle was carried away, or may have been.
bool is_carried_off(const core::Decision& decision);

}  // namespace helixnav::reports
