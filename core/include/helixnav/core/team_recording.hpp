// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/core/robot_sighting.hpp"

namespace helixnav::core {

/// One robot of a team: its own recording, and which robots it saw. All robots share one clock.
struct TeamMember {
  int number = 0;  ///< what the log calls it
  /// Increments also end where another robot saw this one. `start` is in the common frame where starts are known.
  Recording recording;
  std::vector<RobotSighting> sightings;  ///< in time order; `seen` is an index of TeamRecording::robots
};

/// Several robots in one world, as a reader or a simulator hands them out. Estimators never include this header.
struct TeamRecording {
  std::string name;
  std::vector<TeamMember> robots;
  bool starts_known = false;                 ///< Recording::start of each robot is in the frame of the truth
  std::vector<TrueLandmark> true_landmarks;  ///< frame of the truth; also where no robot has a true pose
  double looks_as_one = 1.0;         ///< this many looks in a row say what one would; noise is that of all of them
  int misread = 0;                   ///< sightings of an unknown robot, left out
  std::vector<std::string> remarks;  ///< as Recording::remarks
};

}  // namespace helixnav::core
