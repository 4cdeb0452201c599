// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/runs/run.hpp"
#include "helixnav/runs/run_writer.hpp"

namespace helixnav::reports {

/// Finishes a run that is being written: evaluates it against its truth and hands map, report page and summary to
/// the writer. Test: runs/run_writer_test.cpp.
evaluation::Evaluation finish_run(const runs::Run& run, runs::RunWriter& writer);

}  // namespace helixnav::reports
