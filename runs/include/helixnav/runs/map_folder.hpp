// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/core/joint_map.hpp"

namespace helixnav::runs {

/// Writes map.csv and, for up to most_joint_landmarks, map.bin into a folder that is there: a map to go on in that no single
/// drive made. InputError where the file system refuses. Test: apps/join_test.cpp (replay --map goes on in it).
void write_map(const std::string& folder, const core::JointMap& map);

}  // namespace helixnav::runs
