// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/gaussian.hpp"

namespace helixnav::supervisor {

/// The landmarks of `joint` that are one piece of ground with the least known one within view_m of the vehicle (of all,
/// when none is so near): those better known from it than from the vehicle, by the trace of the relative covariance.
/// Where a drive comes back among trees, others that it has just passed count as old as well; these move with the
/// vehicle, and a frame with one base here and one there, or a prior in it, says nothing about the return. O(n²).
/// Test: supervisor/old_ground_test.cpp.
core::JointGaussian old_ground(const core::JointGaussian& joint, double view_m);

}  // namespace helixnav::supervisor
