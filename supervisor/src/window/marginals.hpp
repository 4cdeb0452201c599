// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/atlas/atlas.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_id.hpp"

namespace helixnav::supervisor {

/// Marginals of landmarks at the settled estimate, in the order given. Landmarks named one after another are mostly
/// near each other and share their paths.
std::vector<core::PointGaussian> marginals_of(const atlas::Atlas& atlas, const std::vector<core::LandmarkId>& ids);

}  // namespace helixnav::supervisor
