// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// The text of summary.json (docs/run-folder.md): counts, errors, the run's own numbers and its wall clock.
/// Test: reports/summary_test.cpp.
std::string summary_json(const runs::Run& run, const evaluation::Evaluation& evaluation);

/// An evaluation for the terminal: one figure per line, with units.
std::string evaluation_text(const evaluation::Evaluation& evaluation);

/// The same as one JSON object, with the key names of summary.json.
std::string evaluation_json(const evaluation::Evaluation& evaluation);

}  // namespace helixnav::reports
