// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "helixnav/core/step_report.hpp"
#include "helixnav/core/team_recording.hpp"
#include "helixnav/team/team.hpp"

namespace helixnav::apps {

/// The result of a team's drive.
struct TeamDrive {
  struct Robot {
    std::vector<core::StepReport> steps;  ///< as estimated then; poses in the frame of the component at the end
    std::vector<double> microseconds;     ///< [step]
    std::vector<std::vector<std::int64_t>> names;  ///< [scan][observation] as given to the team
    std::vector<std::int64_t> at;    ///< [step] 1 if the log has a sighting, 0 if nothing was seen for a while
    int component = 0;               ///< at the end: number of its first robot
    std::size_t wrongly_placed = 0;  ///< steps reported while a join held that was taken back later
    core::Nanoseconds in_frame_since_ns =
        0;  ///< when it came into that frame; earlier covariances do not cover the way there
  };
  std::vector<Robot> robots;
  team::Team team;
  double seconds = 0.0;  ///< wall clock
};

struct TeamTask {
  core::TeamRecording recording;
  bool unknown_starts = false;
  bool known_association = true;
  bool own_names = false;  ///< each robot tells its own landmarks apart with its own navigator, and not another's
  team::TeamOptions options;
  bool quiet = false;
  std::function<void()> before_each_event;  ///< what it throws ends the drive; may be empty
};

/// A team as it is to be driven; association and joins go by names if `known_association`, else by places and constellations.
/// InputError if the starts are to be known and the log does not say them.
TeamTask task_of(core::TeamRecording recording, bool unknown_starts, bool known_association);

/// Feeds all robots' events in order of time, until the program is interrupted.
TeamDrive drive_team(const TeamTask& task);

}  // namespace helixnav::apps
