// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// A warning where the run's numbers say that ranges lack a constant; else empty. Test: apps/range_offset_test.cpp
std::string range_offset_text(const runs::Run& run);

}  // namespace helixnav::reports
