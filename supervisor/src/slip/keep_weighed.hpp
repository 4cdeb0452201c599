// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "slip/relative_geometry.hpp"
#include "slip/slip_evidence.hpp"
#include "slip/slip_places.hpp"

namespace helixnav::supervisor {

/// Of all observations the nearest; what is weighed, and so what the question of a slip costs.
constexpr std::size_t most_weighed = 24;

/// Of a scan with as many observations as are weighed, or more: only those landmarks that one of the weighed may be of, and
/// their neighbours. What is left out would be paired with nothing. `seen`: nearest first.
/// Test: supervisor/slip/keep_weighed_test.cpp (the same slips as without).
void keep_weighed(const cekf::CompressedEkf& filter, const core::Scan& scan, const std::vector<SeenPoint>& seen,
                  const SlipComponent& widest, SlipReach reach, std::vector<core::LandmarkId>& near);

}  // namespace helixnav::supervisor
