// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// Landmarks of searches that ended in a closing and stand beside older ones, nearer than a quarter or a tenth of what landmarks
/// usually are from each other, without ever having been seen in one scan with them: a closing merges what is surely one, and
/// where a road was off by metres that may be a few pairs. Empty unless there are at least three, and five times as
/// many as chance puts there. O(N·√N) for N landmarks. Test: reports/left_twice_text_test.cpp.
std::string left_twice_text(const runs::Run& run);

}  // namespace helixnav::reports
