// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "drive.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/evaluation/evaluation.hpp"

namespace helixnav::apps {

/// What became of the observations of a run.
struct ObservationCounts {
  std::size_t seen = 0, matched = 0, began = 0;

  void add(const core::StepReport& report);
};

/// InputError where the estimator could never map what the log holds: the navigator nothing but ranges or bearings without
/// identities, FastSLAM any range or bearing alone.
void check_observable(const Drive& job);

/// What a user should know of a run that came to its end and is not to be trusted, with what to do: a map without
/// landmarks, matching that collapsed, innovations that contradict the assumed noise, truth of another clock. A sentence
/// each; none of a run that is well. Test: apps/warnings_test.cpp.
std::vector<std::string> warnings_of(const Drive& job, const ObservationCounts& counts,
                                     const std::vector<core::MapLandmark>& map,
                                     const evaluation::Evaluation& evaluation);

}  // namespace helixnav::apps
