// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

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

}  // namespace helixnav::apps
