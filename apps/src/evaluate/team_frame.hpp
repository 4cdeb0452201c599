// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace helixnav::apps {

/// When the robot of a run folder DIR/robot_N came into the frame that its poses are in, s, as DIR/summary.json of its team says.
/// Nothing for the folder of anything else. Test: apps/team_test.cpp.
std::optional<double> in_frame_since_s(const std::string& folder);

}  // namespace helixnav::apps
