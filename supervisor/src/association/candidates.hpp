// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/landmark_id.hpp"

namespace helixnav::supervisor {

/// Landmarks that any observation of the scan may belong to: those closer to where the observation puts them than
/// `sigmas` standard deviations of pose and landmark together, and than one and a half times as many of the difference,
/// correlations included. The first bounds the second whatever the correlation; but far from the start the deviations
/// of pose and landmark are large and nearly the same error, so that their sum takes in hundreds of landmarks, whose
/// joint covariance would cost more than everything else. Nothing inside the exact gate is lost. For observations that
/// do not fix a point (one row), every landmark within the range of the field of view is taken. None of `excluded`
/// (ascending), which cost nothing. O(nearby landmarks · q), and O(q²) for each chosen.
/// Test: supervisor/association/candidates_test.cpp.
std::vector<core::LandmarkId> candidates(const cekf::CompressedEkf& filter, const core::Scan& scan, double sigmas,
                                         const std::vector<core::LandmarkId>& excluded = {});

/// Landmarks whose estimated position lies inside the field of view, at least `margin_m` from its edge: those that
/// should have been seen.
std::vector<core::LandmarkId> expected_in_view(const cekf::CompressedEkf& filter, const core::Scan& scan,
                                               double margin_m);

}  // namespace helixnav::supervisor
