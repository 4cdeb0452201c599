// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/core/se2.hpp"
#include "helixnav/core/time.hpp"

namespace helixnav::team {

/// Two components became one.
struct TeamJoin {
  enum class By { names, sightings, constellation };
  By by = By::names;
  core::Nanoseconds t_ns = 0;
  int robot = 0;                  ///< of the component that kept its frame: the first of its robots
  int other = 0;                  ///< of the component that joined it
  core::Pose2 T_component_other;  ///< frame of the one that came, by the joint solution then
  int merged = 0;                 ///< landmarks that were two
  int left_out = 0;               ///< names common to both that contradict the others
  int sightings = 0;              ///< of robots by one another that it rests on
  double cost = 0.0;              ///< by how much the joint least squares exceeds both apart: χ² with dof
  int dof = 0;
  double limit = 0.0;
};

/// A join that later sightings contradicted, or that was taken back by hand.
struct TakenBackJoin {
  TeamJoin join;
  core::Nanoseconds t_ns = 0;  ///< when it was taken back
  int refused = 0;             ///< sightings between its two sides since then that were refused,
  int seen = 0;                ///< out of so many; 0: taken back by hand
};

/// "names", "sightings", "constellation".
const char* name_of(TeamJoin::By by);

}  // namespace helixnav::team
