// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::runs {

/// Its landmarks one by one, without their cross-covariances.
std::vector<core::MapLandmark> landmarks_of(const core::JointMap& map);

/// Beside the map.bin of a joined map, which has no end pose: digests of what it was joined from.
inline constexpr const char* joined_from_file = "joined_from.csv";
inline constexpr const char* joined_from_header = "sha256,run\n";

/// Writes map.csv and map.bin with drives.csv (see write_joint_map) into an existing folder: a map to go on
/// in that was not made by a single drive; `names` as in runs::Run. If it has no end pose, joined_from.csv marks the
/// pose as not one to go on from. InputError if the file system refuses. Test: apps/go_on_test.cpp (replay --map goes
/// on in it).
void write_map(const std::string& folder, const core::JointMap& map,
               const std::map<core::LandmarkId, std::string>& names = {});

/// Writes map.bin and, if the map knows which drives went into it, drives.csv beside it. Nothing for a map of
/// more than most_joint_landmarks without factors.
void write_joint_map(const std::string& folder, const core::JointMap& map);

/// The drives of the map in a folder, as core::JointMap::drives; none if nobody wrote them. InputError naming the file
/// and the line of an entry that is not a digest.
std::vector<std::string> read_drives(const std::string& folder);

}  // namespace helixnav::runs
