// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// What a run's closings and searches leave in doubt: ground that may be mapped twice because two of three closings were refused or searches
/// ended undecided, and a path that could not be solved as a whole after the last closing. Test: reports/closing_warnings_test.cpp.
std::vector<std::string> closing_warnings(const runs::Run& run);

}  // namespace helixnav::reports
