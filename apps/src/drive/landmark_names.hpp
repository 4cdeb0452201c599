// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "drive.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {

/// What the log calls the landmarks of a run that knew them by name; empty where association was not known.
/// Test: apps/landmark_names_test.cpp
std::map<core::LandmarkId, std::string> landmark_names(const Drive& job, const runs::Run& run);

/// Words are numbered in each log anew, in their order: the labels of landmarks of an earlier map become those that the log gives to
/// their names; names of the map that the log does not have are numbered behind its own. Nothing where either has no words for names.
/// Test: apps/landmark_names_test.cpp
void number_by_names(const std::map<core::LandmarkId, std::string>& names_of_map, core::Recording& recording,
                     std::map<core::Label, core::LandmarkId>& landmark_of);

/// Both for the landmarks `ids` of the map in the folder or map.csv: what `landmark_of` says of them, else their names, as this log calls
/// them.
void call_as_log(const std::string& map, const std::vector<core::LandmarkId>& ids, core::Recording& recording,
                 std::map<core::Label, core::LandmarkId>& landmark_of);

/// Of a map that no single run made, as of join: by what its landmarks are called, numbers as they are. Words get labels that mean nothing
/// before number_by_names. Test: apps/landmark_names_test.cpp
std::map<core::Label, core::LandmarkId> landmarks_by_name(const std::map<core::LandmarkId, std::string>& names_of_map,
                                                          const core::Recording& recording);

}  // namespace helixnav::apps
