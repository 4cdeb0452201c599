// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <vector>

#include "helixnav/core/decision.hpp"
#include "helixnav/core/joint_map.hpp"

namespace helixnav::supervisor {

/// What became of one session.
struct JoinedSession {
  std::size_t component = 0;        ///< of the result
  core::Pose2 T_component_session;  ///< identity for the session that gave the component its frame
  /// How it was placed. For a session that stayed apart: why its best place on the first component was not accepted;
  /// for the very first session: `sought`, without numbers.
  core::PlacedDecision decision;
  std::map<core::LandmarkId, core::LandmarkId> name_of;  ///< mature landmarks of the session, by their names in it
};

/// Maps of several sessions, joined into as few as the evidence allows.
struct JoinedSessions {
  std::vector<core::JointMap> components;  ///< mature landmarks only, no end pose; that of the largest session first
  std::vector<JoinedSession> sessions;     ///< [session]
};

/// Joins maps made independently of each other, each in its own frame, without a prior. The session with the most
/// mature landmarks gives a component its frame; every other session queries that component for its place
/// (relocalize::ask, with constellations of up to 40 landmarks from all over its map) and is merged with it if the
/// answer is closed and the χ² of the pairs passes (join_maps); the sessions still apart query the joined component
/// again, and those that stay apart begin the next component. α = 1e-5 bounds the probability of a false answer for
/// each pair of sessions. The result does not depend on the order of the sessions, except for the numbering of sessions
/// of equal size. PreconditionError for a map whose parts do not fit together. Cost: for each pair of sessions an index
/// and a query every 20 landmarks, and O(N²·pairs) for each join. `now_and_then` is called before each query; an
/// exception it throws ends the call. Test: supervisor/placing/join_sessions_test.cpp.
JoinedSessions join_sessions(
    const std::vector<core::JointMap>& sessions, const std::function<void()>& now_and_then = [] {});

}  // namespace helixnav::supervisor
