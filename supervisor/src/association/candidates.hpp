// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/landmark_id.hpp"

namespace helixnav::supervisor {

/// Landmarks that any observation of the scan may belong to: those whose distance from where the observation puts them
/// is less than `sigmas` standard deviations of pose and landmark together. The sum of deviations bounds the relative
/// one whatever their correlation, so that nothing inside the exact gate is lost. Observations that fix no point (one
/// row) take every landmark within the range of the field of view.
std::vector<core::LandmarkId> candidates(const cekf::CompressedEkf& filter, const core::Scan& scan, double sigmas);

/// Landmarks whose estimated position lies inside the field of view, at least `margin_m` from its edge: those that
/// should have been seen.
std::vector<core::LandmarkId> expected_in_view(const cekf::CompressedEkf& filter, const core::Scan& scan,
                                               double margin_m);

}  // namespace helixnav::supervisor
