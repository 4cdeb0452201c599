// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/fastslam/fast_slam.hpp"

namespace helixnav::fastslam {

/// One scan of any size: of more than core::most_observations_used observations only those named by
/// core::observations_to_use are used, and the report says so. Errors: as FastSlam::update.
core::StepReport observe(FastSlam& slam, const core::Scan& scan);

/// The same with Association::known, one label per observation. A negative label is not a landmark, and of a label
/// that occurs twice the first counts; both are reported as rejected. Test: fastslam/observe_test.cpp.
core::StepReport observe_known(FastSlam& slam, const core::Scan& scan, const std::vector<KnownName>& labels);

}  // namespace helixnav::fastslam
