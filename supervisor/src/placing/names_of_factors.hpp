// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/core/map_factors.hpp"

namespace helixnav::supervisor {

/// Leaves the names of these landmarks (ascending): the others stay in the factors without a name, which somebody else may
/// have.
void keep_names(const std::vector<core::LandmarkId>& ids, core::MapFactors& factors);

}  // namespace helixnav::supervisor
