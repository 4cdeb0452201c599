// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "helixnav/core/recording.hpp"
#include "helixnav/smoothing/problem.hpp"
#include "helixnav/supervisor/navigator_options.hpp"

namespace helixnav::apps {

/// A log with the associations of a run through it, solved as a whole.
struct SettledDrive {
  smoothing::Problem problem;  ///< at its optimum
  std::size_t observations = 0, used = 0;
  std::size_t closings = 0;
  double nis_per_dof = 0.0;  ///< of the run
};

/// Navigates and solves; observations of mature landmarks are used. core::InputError when the run maps no landmark,
/// core::NumericalError where the mathematics breaks.
SettledDrive settle(const core::Recording& recording, const supervisor::NavigatorOptions& options,
                    bool known_association);

}  // namespace helixnav::apps
