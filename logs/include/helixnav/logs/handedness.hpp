// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "helixnav/core/recording.hpp"

namespace helixnav::logs {

/// Returns a sentence if, while the vehicle turns, the points of a scan are found again in a later one clearly more
/// often with bearings or turns of the opposite sign: one of the two is then counted clockwise in the log. O(scans
/// observations²). Test: logs/own/own_handedness_test.cpp.
std::optional<std::string> doubt_handedness(const core::Recording& recording);

}  // namespace helixnav::logs
