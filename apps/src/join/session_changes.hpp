// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/core/joint_map.hpp"
#include "helixnav/supervisor/join_sessions.hpp"

namespace helixnav::apps {

enum class Change { kept, gone, appeared, both };

/// A landmark of a joined map that not every session which looked there has.
struct ChangedLandmark {
  std::size_t component;
  core::LandmarkId id;
  Eigen::Vector2d point_m;
  std::vector<std::size_t> seen_in, missing_in;  ///< sessions, ascending
  Change change() const;
};

/// "kept", "gone" (in no session after one that has it), "new" (in no session before), "both" (it went and came).
const char* name_of(Change change);

/// Sessions in order of time. A session looked at the ground about its own landmarks: about each, 0.6 of the way to its eighth
/// neighbour. Joint landmarks only: those on ground of one session are left out. O(N²).
std::vector<ChangedLandmark> shared_landmarks(const std::vector<core::JointMap>& sessions,
                                              const supervisor::JoinedSessions& joined);

}  // namespace helixnav::apps
