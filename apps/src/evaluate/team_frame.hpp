// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace helixnav::apps {

/// When the robot of a run folder DIR/robot_N came into the frame that its poses are in, s, from its team's DIR/summary.json.
/// Nothing for any other folder. Test: apps/team_test.cpp.
std::optional<double> in_frame_since_s(const std::string& folder);

}  // namespace helixnav::apps
