// SPDX-License-Identifier: BSD-3-Clause
#include "join/joined_names.hpp"

#include <gtest/gtest.h>

namespace helixnav::apps {
namespace {

/// Landmarks 0 to 3 of a map; both runs have all of them under the same numbers.
supervisor::JoinedSessions two_runs_of_four() {
  supervisor::JoinedSessions joined;
  core::JointMap& map = joined.components.emplace_back();
  joined.sessions.resize(2);
  for (core::LandmarkId id = 0; id < 4; ++id) {
    map.joint.ids.push_back(id);
    map.states.push_back(core::LandmarkState::mature);
    for (supervisor::JoinedSession& session : joined.sessions) session.name_of[id] = id;
  }
  return joined;
}

TEST(JoinedNames, AreThoseOfTheCopies) {
  const JoinedNames names =
      joined_names({{{0, "oak"}, {1, "elm"}, {9, "dead"}}, {{1, "elm"}, {2, "beech"}}}, two_runs_of_four());
  ASSERT_EQ(names.of_component.size(), 1u);
  EXPECT_EQ(names.of_component[0], (LandmarkNames{{0, "oak"}, {1, "elm"}, {2, "beech"}}));
  EXPECT_TRUE(names.notes.empty());
}

TEST(JoinedNames, ThatContradictWhereLandmarksStandAreLeftOutAndSaid) {
  const JoinedNames names = joined_names(
      {{{0, "oak"}, {1, "elm"}, {2, "beech"}}, {{0, "ash"}, {1, "elm"}, {3, "beech"}}}, two_runs_of_four());
  EXPECT_EQ(names.of_component[0], (LandmarkNames{{1, "elm"}}));
  ASSERT_EQ(names.notes.size(), 1u);
  EXPECT_NE(names.notes[0].find("'ash' is also 'oak'"), std::string::npos) << names.notes[0];
  EXPECT_NE(names.notes[0].find("'beech'"), std::string::npos) << names.notes[0];
}

TEST(JoinedNames, GoWithALandmarkThatWasMoved) {
  supervisor::JoinedSessions joined = two_runs_of_four();
  joined.components[0].states[2] = core::LandmarkState::tentative;
  const JoinedNames names = joined_names({{{2, "beech"}}, {{3, "beech"}}}, joined);
  EXPECT_EQ(names.of_component[0], (LandmarkNames{{3, "beech"}}));
  EXPECT_TRUE(names.notes.empty());
}

}  // namespace
}  // namespace helixnav::apps
