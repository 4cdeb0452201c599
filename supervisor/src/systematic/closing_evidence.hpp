// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "helixnav/core/step_report.hpp"
#include "loop/tape.hpp"
#include "systematic/stretch_evidence.hpp"

namespace helixnav::supervisor {

/// The scans of the loop that is closed by the merges at the end of a tape: from one reach before the last sighting of an old landmark
/// that was merged, a quarter of a reach apart or, if they would be more than some two hundred, as much farther. None if that is more
/// than half a reach, if the loop is not on the tape, or if nothing is merged at its end.
std::vector<Stop> stops_of_closing(const Tape& tape, double reach_m);

/// What that closing says about systematic errors: what the loop says with its landmarks merged, less what it says without.
/// Independent of what the stretches of the loop say, since that is in both. Nothing without those scans, or if least squares do not
/// converge. Its rows are not counted. `path`: where the drive was solved, to begin at; empty: dead reckoning. Cost: some ten factorisations of as many poses.
/// Test: supervisor/systematic/closing_evidence_test.cpp.
std::optional<StretchEvidence> evidence_of_closing(const Tape& tape, const std::vector<core::StampedPose>& path,
                                                   double reach_m);

}  // namespace helixnav::supervisor
