// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/core/joint_map.hpp"
#include "helixnav/supervisor/join_sessions.hpp"

namespace helixnav::apps {

enum class Change { kept, gone, appeared, both, moved };

/// A landmark of a joined map on ground that several sessions looked at.
struct ChangedLandmark {
  std::size_t component;
  core::LandmarkId id;
  Eigen::Vector2d point_m;
  std::vector<std::size_t> seen_in, missing_in;  ///< sessions, ascending
  core::LandmarkId counterpart =
      core::no_landmark;  ///< moved: what is gone has the new one here, and the other way round

  Change change() const;
  /// In no session after one that looked there and did not see it.
  bool is_gone() const { return !missing_in.empty() && missing_in.front() > seen_in.back(); }
};

/// "kept", "gone" (in no session after one that has it), "new" (in no session before), "both" (it went and came), "moved" (gone
/// here and new near by).
const char* name_of(Change change);

/// Sessions in order of time. A session looked at the ground about its own landmarks: about each, 0.6 of the way to its eighth
/// neighbour, as far as its landmarks are on all sides. What it has not got there it says of those only that have half of its eight nearest
/// landmarks there, or whose half it has: others were bent apart, and hold copies. Joint landmarks only: those on ground of one session are left out. O(N²).
/// Moved are one that is gone and one that is new in a session after, each the other's nearest and nearer than chance would put
/// new ones, as dense as they are: of the moves told 5 % are wrong in the mean. Test: apps/session_changes_test.cpp.
std::vector<ChangedLandmark> shared_landmarks(const std::vector<core::JointMap>& sessions,
                                              const supervisor::JoinedSessions& joined);

/// What is gone is tentative from here on: no place is found by it, a session that goes on in the map forgets it after a few
/// looks that do not see it, and the next join leaves it out.
void make_gone_tentative(const std::vector<ChangedLandmark>& shared, std::vector<core::JointMap>& components);

}  // namespace helixnav::apps
