// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/supervisor/navigator_options.hpp"
#include "smooth/smoothing_task.hpp"

namespace helixnav::apps {

/// A log with the associations of a run through it.
struct SettledDrive {
  SmoothingTask task;                ///< where the run left it
  Ids ids;                           ///< associations that it was built with
  std::vector<std::size_t> slipped;  ///< scans before which the odometry slipped, which splits the task
  std::size_t observations = 0, used = 0;
  std::size_t closings = 0;
  double nis_per_dof = 0.0;           ///< of the run
  double nis_per_dof_held_out = 0.0;  ///< of the run in the last part
};

/// Parts of a log, each of which judges the constants fitted to the others; the last judges by a run, too.
inline constexpr int parts_held_out = 4;

/// Navigates; observations of mature landmarks are used. core::InputError if the run maps no landmark,
/// core::NumericalError if the mathematics breaks down, Interrupted on SIGINT.
SettledDrive drive_through(const core::Recording& recording, const supervisor::NavigatorOptions& options,
                           bool known_association);

}  // namespace helixnav::apps
