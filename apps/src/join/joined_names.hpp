// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "helixnav/supervisor/join_sessions.hpp"

namespace helixnav::apps {

using LandmarkNames = std::map<core::LandmarkId, std::string>;

/// From the map.csv in the folder of a run; none if there is no such file.
LandmarkNames landmark_names_in(const std::string& folder);

/// The names of the landmarks of a joined map.
struct JoinedNames {
  std::vector<LandmarkNames> of_component;
  std::vector<std::string> notes;  ///< a sentence for each component on which names contradict each other
};

/// `of_runs`: [session] by the ids of its own map, empty if landmarks were not known by name. A landmark of the joined map gets
/// the name of its copies. Maps are joined by landmark positions, and names may contradict that: a landmark with different names
/// in different runs, and landmarks that share a name, stay unnamed; if a landmark that is gone (tentative) and a current one
/// have the same name, the latter keeps it. Test: apps/joined_names_test.cpp.
JoinedNames joined_names(const std::vector<LandmarkNames>& of_runs, const supervisor::JoinedSessions& joined);

}  // namespace helixnav::apps
