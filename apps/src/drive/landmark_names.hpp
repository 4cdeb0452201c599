// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "drive.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {

/// The log's names for the landmarks of a run with known association; empty if association was not known.
/// Test: apps/landmark_names_test.cpp
std::map<core::LandmarkId, std::string> landmark_names(const Drive& job, const runs::Run& run);

/// Words are numbered anew in each log, in their order: the labels of landmarks of an earlier map become those that the log gives to
/// their names; names of the map that the log does not have are numbered after its own. Nothing if either has no words for names.
/// Test: apps/landmark_names_test.cpp
void number_by_names(const std::map<core::LandmarkId, std::string>& names_of_map, core::Recording& recording,
                     std::map<core::Label, core::LandmarkId>& landmark_of);

/// Both for the landmarks `ids` of the map in the folder or map.csv: from `landmark_of`, else their names, as this log calls them. None if
/// this log has words for names and the map has no names, as after a run without known association.
/// Test: apps/landmark_names_test.cpp
void call_as_log(const std::string& map, const std::vector<core::LandmarkId>& ids, core::Recording& recording,
                 std::map<core::Label, core::LandmarkId>& landmark_of);

/// For a map made by no single run, such as one from join: by the names of its landmarks, numbers unchanged. Words get labels that mean
/// nothing before number_by_names. Test: apps/landmark_names_test.cpp
std::map<core::Label, core::LandmarkId> landmarks_by_name(const std::map<core::LandmarkId, std::string>& names_of_map,
                                                          const core::Recording& recording);

}  // namespace helixnav::apps
