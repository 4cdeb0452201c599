// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "helixnav/logs/evaluation.hpp"
#include "helixnav/logs/run_folder.hpp"
#include "helixnav/logs/smoothed_run.hpp"

namespace helixnav::logs {

/// The page report.html of a run: data, charts and charting library in one text that needs no network. Wall-clock
/// figures stand in the element with id "wall-clock" and nowhere else. `timing` are the caller's totals (name, value); `smoothed` null: no smoother ran.
/// Test: logs/report_test.cpp.
std::string render_report(const RunFolder& run, const Evaluation& evaluation,
                          const std::vector<std::pair<std::string, double>>& timing = {},
                          const SmoothedRun* smoothed = nullptr);

}  // namespace helixnav::logs
