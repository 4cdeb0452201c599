// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/evaluation/evaluation.hpp"

namespace helixnav::evaluation {

/// Mature landmarks of the run, moved by `T_truth_map`, against the true ones. With labels, the partner of a true
/// landmark is the one with most observations among those whose observations mostly carry its label; without, or if no
/// observation carries the label of a true landmark, pairs are taken in order of distance up to `limit_m`, or up to
/// four standard deviations of the landmark but no more than half-way from the true one to the next. Cost O(landmarks ×
/// true landmarks) at most. Test: evaluation/evaluation_map_test.cpp.
MapEvaluation evaluate_map(const runs::Run& run, const runs::RunTruth& truth, const core::Pose2& T_truth_map,
                           double limit_m);

}  // namespace helixnav::evaluation
