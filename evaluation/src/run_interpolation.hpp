// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "helixnav/core/step_report.hpp"

namespace helixnav::evaluation {

/// Estimate of the run at `t_ns`: pose interpolated between the steps around it, covariance of the step before.
/// Nothing outside the steps' time. Cost O(log n). Test: evaluation/evaluation_test.cpp.
std::optional<core::PoseGaussian> estimate_at(const std::vector<core::StepReport>& steps, core::Nanoseconds t_ns);

}  // namespace helixnav::evaluation
