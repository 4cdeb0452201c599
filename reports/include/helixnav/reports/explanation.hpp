// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "helixnav/runs/run_folder.hpp"

namespace helixnav::reports {

/// A run in sentences, from its recorded numbers only: nothing is recomputed.

/// How many loops were closed, refused or left open, and a sentence on each.
std::string explain_run(const runs::Run& run);

/// Closure number `closure`, counted from 1, and everything since the trigger that led to it. InputError when the run
/// has fewer.
std::string explain_closure(const runs::Run& run, std::size_t closure);

/// What became of every observation of a step, and why; what was decided. InputError when the run has no such step.
std::string explain_step(const runs::Run& run, std::int64_t step);

}  // namespace helixnav::reports
