// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/supervisor/join_sessions.hpp"
#include "joined_names.hpp"
#include "session_changes.hpp"

namespace helixnav::apps {

/// Joined maps must count their information only once: InputError for a run folder that is listed twice, or whose map another one holds,
/// because it continued in it or was joined from it, and for two that hold the map of a third.
void check_independent(const std::vector<std::string>& runs);

/// Likewise for the maps themselves, `names` in messages: the same map twice, or two that hold the same drive.
void check_independent(const std::vector<core::JointMap>& maps, const std::vector<std::string>& names);

/// Records in the components which drives went into them.
void tell_drives(const std::vector<core::JointMap>& maps, supervisor::JoinedSessions& joined);

/// Writes the result of several sessions: the first component's map into `out`, which is made, the others' below it, and
/// joined_from.csv, joins.csv, changes.csv and report.html. `names` are the sessions', `landmarks` [component] the names of its
/// landmarks, if they are known by name.
void write_joined(const std::string& out, const std::vector<std::string>& names,
                  const supervisor::JoinedSessions& joined, const std::vector<ChangedLandmark>& shared,
                  const std::vector<LandmarkNames>& landmarks = {});

}  // namespace helixnav::apps
