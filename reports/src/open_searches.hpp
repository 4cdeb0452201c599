// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// What searches left in doubt if no closing followed: one still open at the end, the last one that ended undecided, or the last that ended as
/// new ground although three of the landmarks mapped in it are at the places of old ones, within 99 % by their covariances. Each may have put
/// landmarks on the map twice. Otherwise empty, as also if fewer than three lasting landmarks began in it, and for a run that only localised.
/// Test: reports/open_searches_test.cpp.
std::string open_search_text(const runs::Run& run);

}  // namespace helixnav::reports
