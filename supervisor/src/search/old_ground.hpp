// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/gaussian.hpp"

namespace helixnav::supervisor {

/// The landmarks of `joint` that locate the vehicle: those that it may see, within range_m and two standard
/// deviations of their distance, and those better known from one of these than from the vehicle, by the trace of the
/// relative covariance; all when it may see none. Where a drive comes back among trees, others that it has just passed
/// are old as well; these move with the vehicle, and a frame with one base among them, or a prior in it, says nothing
/// about the return. O(n²). Test: supervisor/search/old_ground_test.cpp.
core::JointGaussian old_ground(const core::JointGaussian& joint, double range_m);

}  // namespace helixnav::supervisor
