// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "json.hpp"

namespace helixnav::reports {

/// What reports/page/report.js draws, in columns; thinned to a few thousand points per line. No wall-clock
/// figures.
Json report_data(const runs::Run& run, const evaluation::Evaluation& evaluation);

/// The wall-clock figures of the report: totals, and step times by blocks (maximum and median).
Json report_wall_clock(const runs::Run& run);

}  // namespace helixnav::reports
