// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "helixnav/supervisor/join_sessions.hpp"

namespace helixnav::apps {

using LandmarkNames = std::map<core::LandmarkId, std::string>;

/// Of the map.csv in the folder of a run; none where there is no such file.
LandmarkNames landmark_names_in(const std::string& folder);

/// What the landmarks of a joined map are called.
struct JoinedNames {
  std::vector<LandmarkNames> of_component;
  std::vector<std::string> notes;  ///< a sentence for each component on which names contradict one another
};

/// `of_runs`: [session] by the ids of its own map, empty where landmarks were not known by name. A landmark of the joined map is called
/// as its copies are. Maps are joined by where landmarks stand, and names may contradict that: a landmark that runs call differently, and
/// a name that several landmarks have, stay without; of a landmark that is gone (tentative) and one that has its name now, the latter
/// keeps it. Test: apps/joined_names_test.cpp.
JoinedNames joined_names(const std::vector<LandmarkNames>& of_runs, const supervisor::JoinedSessions& joined);

}  // namespace helixnav::apps
