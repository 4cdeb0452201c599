// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "team/team_drive.hpp"

namespace helixnav::apps {

/// What a user should know about a team run that is not to be trusted, one sentence each: robots, and pairs of robots, with more than a
/// fifth of their sightings refused; robots with ten refused in a row, or with innovations larger than assumed; robots in two frames
/// that share names of landmarks; without names, robots that begin landmarks where they miss the ones they knew (mapped_anew).
/// Test: apps/hostile/bad_team_log_test.cpp.
std::vector<std::string> team_warnings(const TeamTask& task, const TeamDrive& drive);

}  // namespace helixnav::apps
