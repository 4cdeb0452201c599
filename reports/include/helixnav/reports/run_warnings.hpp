// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/core/decision.hpp"
#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// What a user should know about a run that is not to be trusted, and what to do: a map without landmarks, matching
/// that collapsed, innovations that contradict the assumed noise, truth from another clock. One sentence each; none for
/// a good run. Test: apps/hostile/warnings_test.cpp.
std::vector<std::string> warnings_of(const runs::Run& run, const evaluation::Evaluation& evaluation);

/// Warns that no scan came in, that nothing was detected, or that no landmark could be placed although there were scans enough to tell:
/// otherwise empty. Test: reports/opening_test.cpp.
std::string nothing_mapped_text(const runs::Run& run);

/// Warns that the whole map was repeatedly sure of another place than the vehicle was believed to be at, and nothing
/// came of it: otherwise empty. Test: reports/opening_test.cpp.
std::string contradicted_place_text(const runs::Run& run);

/// Warns that the place on an earlier map, or on what was mapped before the vehicle was carried, was sought and not
/// found, and what the best answer lacked: otherwise empty. Test: reports/opening_test.cpp.
std::string place_not_found_text(const runs::Run& run);

/// Whether a start that was given on an earlier map was found to be wrong: nobody carried the vehicle.
bool is_wrong_start(const core::Decision& decision);

/// Warns if the run ended without knowing its place, or went on for long without a landmark that it knew. Test:
/// reports/opening_test.cpp.
std::vector<std::string> warnings_of_place(const runs::Run& run);

}  // namespace helixnav::reports
