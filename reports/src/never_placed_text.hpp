// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// Parts of a drive whose place was never found although another one began after them, with when they were; empty if there
/// is none. The last part is place_not_found_text's. Test: reports/never_placed_text_test.cpp.
std::string never_placed_text(const runs::Run& run);

}  // namespace helixnav::reports
