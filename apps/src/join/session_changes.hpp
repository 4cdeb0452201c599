// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/core/joint_map.hpp"
#include "helixnav/supervisor/join_sessions.hpp"

namespace helixnav::apps {

enum class Change { kept, gone, appeared, both, moved };

/// A landmark of a joined map on ground that several sessions observed.
struct ChangedLandmark {
  std::size_t component;
  core::LandmarkId id;
  Eigen::Vector2d point_m;
  std::vector<std::size_t> seen_in, missing_in;  ///< sessions, ascending
  core::LandmarkId counterpart =
      core::no_landmark;  ///< moved: the landmark that is gone has the new one here, and vice versa

  Change change() const;
  /// Seen in no session after the first one that looked there and did not see it.
  bool is_gone() const { return !missing_in.empty() && missing_in.front() > seen_in.back(); }
};

/// "kept", "gone" (in no session after one that has it), "new" (in no session before), "both" (it both came and went),
/// "moved" (gone here and new nearby).
const char* name_of(Change change);

/// Sessions in order of time. A session looked at the ground around its own landmarks: around each, 0.6 of the way to
/// its eighth neighbour, if its landmarks are there on all sides. A landmark of another session that it lacks there
/// counts as missing only if that session has half of its eight nearest landmarks there, or it has half of that
/// session's: otherwise the two were bent apart, and hold copies. Joint landmarks only: those on ground of one session
/// are left out. O(N²). A landmark that is gone within what two drives see of one (99 %) of a new one is still there:
/// both are kept. A move is one landmark that is gone and one that is new in a later session, each the other's nearest
/// and nearer than chance would put new ones at their density: 5 % of the reported moves are wrong on average.
/// Test: apps/session_changes_test.cpp.
std::vector<ChangedLandmark> shared_landmarks(const std::vector<core::JointMap>& sessions,
                                              const supervisor::JoinedSessions& joined);

/// A landmark that is gone is tentative from here on: it is not used for relocalisation, a session that continues in the map
/// forgets it after a few looks that do not see it, and the next join leaves it out.
void make_gone_tentative(const std::vector<ChangedLandmark>& shared, std::vector<core::JointMap>& components);

}  // namespace helixnav::apps
