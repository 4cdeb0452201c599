// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/supervisor/join_sessions.hpp"
#include "session_changes.hpp"

namespace helixnav::apps {

/// report.html of joined sessions: how each was placed, and every component with what changed on it. A single text without
/// network access or scripts, in the reader's colours (light or dark).
std::string joined_page(const std::vector<std::string>& names, const supervisor::JoinedSessions& joined,
                        const std::vector<ChangedLandmark>& shared);

}  // namespace helixnav::apps
