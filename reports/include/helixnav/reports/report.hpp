// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// The page report.html of a run: data, charts and charting library in one text that needs no network. Wall-clock
/// figures appear only in the element with id "wall-clock". Test: reports/report_test.cpp.
std::string render_report(const runs::Run& run, const evaluation::Evaluation& evaluation);

}  // namespace helixnav::reports
