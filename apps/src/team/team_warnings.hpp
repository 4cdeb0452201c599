// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "team/team_drive.hpp"

namespace helixnav::apps {

/// What a user should know of a team's run that is not to be trusted, a sentence each: robots, and
/// each two by one another, of whose sightings more than a fifth were refused; robots in two frames that have names of landmarks in
/// common; without names, robots that begin landmarks where they miss those that they knew (mapped_anew). Test: apps/hostile/bad_team_log_test.cpp.
std::vector<std::string> team_warnings(const TeamTask& task, const TeamDrive& drive);

}  // namespace helixnav::apps
