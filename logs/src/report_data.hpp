// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "run_json.hpp"

namespace helixnav::logs {

/// What logs/report/report.js draws, in columns; thinned to a few thousand points a line. No wall-clock figure.
Json report_data(const RunFolder& run, const Evaluation& evaluation);

/// The wall-clock figures of the report: totals, and step times by blocks (maximum and median).
Json report_wall_clock(const RunFolder& run, const std::vector<std::pair<std::string, double>>& timing);

}  // namespace helixnav::logs
