// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "helixnav/core/step_report.hpp"

namespace helixnav::evaluation {

/// Estimate of the run at `t_ns`: pose interpolated between the steps around it, covariance of the step before. Nothing
/// outside the time of the steps. Cost O(log n). Test: evaluation/evaluation_test.cpp.
std::optional<core::PoseGaussian> estimate_at(const std::vector<core::StepReport>& steps, core::Nanoseconds t_ns);

/// How far apart two steps may be for the path between them to be that of the vehicle: three times the 90 % quantile of
/// the intervals. In a longer gap between scans an arc of constant twist is a guess.
core::Nanoseconds most_apart_ns(const std::vector<core::StepReport>& steps);

/// Between two steps that are farther apart than that.
bool is_in_gap(const std::vector<core::StepReport>& steps, core::Nanoseconds t_ns, core::Nanoseconds most_apart_ns);

}  // namespace helixnav::evaluation
