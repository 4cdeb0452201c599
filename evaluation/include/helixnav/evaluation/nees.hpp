// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/se2.hpp"

namespace helixnav::evaluation {

/// eᵀP⁻¹e of e = estimate − truth in (x, y, heading), heading wrapped; NaN if P is not positive definite.
/// Test: evaluation/evaluation_test.cpp.
double nees(const core::PoseGaussian& estimate, const core::Pose2& truth);

}  // namespace helixnav::evaluation
