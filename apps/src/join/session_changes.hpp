// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "helixnav/core/joint_map.hpp"
#include "helixnav/supervisor/join_sessions.hpp"
#include "session_views.hpp"

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

  /// No session has both, and by what is known of them the two may be one landmark that is left on the map twice.
  core::LandmarkId perhaps_copy_of = core::no_landmark;
  /// The largest probability with which one of the sessions that lack it would have missed it if it had stood there; NaN if none lacks
  /// it, or if one whose looks are not known does.
  double missed_by_chance = std::numeric_limits<double>::quiet_NaN();

  Change change() const;
  /// Seen in no session after the first one that looked there and did not see it.
  bool is_gone() const { return !missing_in.empty() && missing_in.front() > seen_in.back(); }
};

/// "kept", "gone" (in no session after one that has it), "new" (in no session before), "both" (it both came and went),
/// "moved" (gone here and new nearby).
const char* name_of(Change change);

/// Sessions in order of time. A landmark of another session is missing in one if that one should have mapped it: the
/// probability that its own looks (`views`, [session], or none where they are not known) missed what stands there is below 1 in 1000,
/// for a landmark that is as easily seen as this one was where it was seen. If its looks are not known, a session counts as
/// having looked at the ground around its own landmarks: around each, 0.6 of the way to its eighth neighbour, if its landmarks
/// are there on all sides and the three nearest are within half the reach and were seen half as often as its others. In both cases
/// that session has half of the other's eight nearest landmarks there, or the other way round: otherwise the two were bent
/// apart, and hold copies. Joint landmarks only: those on ground of one session are left out. O(N²), and O(N·looks) with
/// views. A landmark that is gone within what two drives see of one (99 %) of a new one is still there: both are kept. A
/// move is one landmark that is gone and one that is new in a later session, each the other's nearest and nearer than chance
/// would put new ones at their density: 5 % of the reported moves are wrong on average. Possible copies (left_double) are listed on
/// any ground, and neither is missing where the other was seen.
/// Test: apps/session_changes_test.cpp.
std::vector<ChangedLandmark> shared_landmarks(const std::vector<core::JointMap>& sessions,
                                              const supervisor::JoinedSessions& joined,
                                              const std::vector<std::optional<SessionViews>>& views = {});

/// A landmark that is gone is tentative from here on: it is not used for relocalisation, a session that continues in the map
/// forgets it after a few looks that do not see it, and the next join leaves it out.
void make_gone_tentative(const std::vector<ChangedLandmark>& shared, std::vector<core::JointMap>& components);

}  // namespace helixnav::apps
