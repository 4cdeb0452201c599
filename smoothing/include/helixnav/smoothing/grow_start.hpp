// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/smoothing/problem.hpp"

namespace helixnav::smoothing {

/// Start values found as the robot would find them: the first `poses_per_stage` poses are solved, the next ones are
/// dead reckoned from the last solved pose, new landmarks are placed from there, both are solved together, and so on.
/// Drift never grows beyond one stage, whereas dead reckoning of the whole drive ends in a local minimum. Poses are
/// taken in the order of their indices; a landmark joins when its observations have two rows to spare or fix a point
/// alone. Every stage is solved loosely (a few Levenberg–Marquardt steps); optimize() finishes.
/// Cost: number of stages times about five factorisations of half the problem. The problem's start values are replaced.
/// Errors as check_problem. Test: smoothing/victoria_park_test.cpp (iSAM graph: 6184 where odometry alone ends above
/// 500 000).
void grow_start(Problem& problem, int poses_per_stage = 200);

}  // namespace helixnav::smoothing
