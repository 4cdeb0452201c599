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
  Ids ids;                           ///< associations that it was made with
  std::vector<std::size_t> slipped;  ///< scans before which the odometry slipped, which cuts the task
  std::size_t observations = 0, used = 0;
  std::size_t closings = 0;
  double nis_per_dof = 0.0;           ///< of the run
  double nis_per_dof_held_out = 0.0;  ///< of the run in the last part
};

/// Parts of a log, of which each judges the constants that are fitted to the others; the last judges by a run, too.
inline constexpr int parts_held_out = 4;

/// Navigates; observations of mature landmarks are used. core::InputError when the run maps no landmark,
/// core::NumericalError where the mathematics breaks, Interrupted on SIGINT.
SettledDrive drive_through(const core::Recording& recording, const supervisor::NavigatorOptions& options,
                           bool known_association);

}  // namespace helixnav::apps
