// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/association/landmark_life.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::supervisor {

/// Whether landmarks known before everything in view vanished, at `since_m` of the drive, are seen again: as many as a place needs, and
/// not few of all that was seen since. Then the vehicle slipped, and its pose holds as the filter has it. Test:
/// supervisor/slip/untied_test.cpp.
bool is_tied_again(const association::LandmarkLife& existence, double since_m);

/// Whether a closing ties it: most of what it merged was known before. Where a lost vehicle returns to what it has mapped since it was
/// lost, both are as lost as before. `merged`: the kept ones exist. Test: supervisor/slip/untied_test.cpp.
bool is_tied_by(const std::vector<core::MergedLandmarks>& merged, const association::LandmarkLife& existence,
                double since_m);

/// The pose of a vehicle that may have been carried anywhere: nothing ties it to what was mapped before `since_m` of the drive. The mean is
/// the filter's. The covariance is the filter's plus the second moment, about that mean, of where the vehicle may be: beside any landmark
/// known before, to within the sensor's reach and heading anywhere. So a vehicle that was carried to a place on the map has a NEES of
/// three on the mean, wherever that is; one that was carried farther is not described. O(landmarks). Test:
/// supervisor/slip/untied_test.cpp.
core::PoseGaussian pose_anywhere(const cekf::CompressedEkf& filter, const association::LandmarkLife& existence,
                                 double since_m, double reach_m);

}  // namespace helixnav::supervisor
