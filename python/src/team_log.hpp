// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "helixnav/core/team_recording.hpp"
#include "team/team_drive.hpp"
#include "team/team_evaluation.hpp"

namespace helixnav::python {

/// The drives of several robots.
struct TeamLog {
  core::TeamRecording recording;
  std::vector<std::string> files;  ///< that it was read from
  std::uint64_t seed = 0;
};

/// What a team made of them, and what it is worth.
struct TeamRun {
  apps::TeamTask task;
  apps::TeamDrive drive;
  apps::TeamEvaluation evaluation;
};

}  // namespace helixnav::python
