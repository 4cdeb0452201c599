// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/supervisor/join_sessions.hpp"
#include "session_changes.hpp"

namespace helixnav::apps {

/// What a user should know of joined maps before going on in them: components of which many landmarks are on the map twice. Some are
/// neighbours that each session missed one of; many are ground that two sessions left twice. Test: apps/session_changes_test.cpp.
std::vector<std::string> joined_warnings(const supervisor::JoinedSessions& joined,
                                         const std::vector<ChangedLandmark>& shared);

}  // namespace helixnav::apps
