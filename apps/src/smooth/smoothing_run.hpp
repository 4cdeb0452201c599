// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "helixnav/core/step_report.hpp"
#include "helixnav/runs/smoothed_run.hpp"
#include "helixnav/smoothing/smooth.hpp"
#include "smoothing_task.hpp"

namespace helixnav::apps {

/// A solution with all that is worth reporting.
struct SmoothingResult {
  smoothing::Problem started;  ///< the problem at the start values of the last solution
  smoothing::Report report;
  runs::SmoothedRun run;
  std::vector<std::pair<std::string, double>> numbers;  ///< for summary.json: chi2, dof, …
  double solving_s = 0.0;
};

/// Solves task.problem in place.
SmoothingResult solve(SmoothingTask& task, const smoothing::SmoothOptions& options);

/// One report per step of the values in `problem`, every located observation matched; `nis` of its residual.
std::vector<core::StepReport> steps_of(const SmoothingTask& task, const smoothing::Problem& problem);

/// χ² by kind, degrees of freedom, factor of overconfidence, iterations; ends with a newline.
std::string text_of(const SmoothingTask& task, const SmoothingResult& result);

}  // namespace helixnav::apps
