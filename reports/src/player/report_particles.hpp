// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/runs/run.hpp"
#include "json.hpp"

namespace helixnav::reports {

/// What the page draws of a particle cloud: its health over time, its paths, its landmarks as estimated by the whole
/// cloud.
Json particles_data(const runs::Run& run);

}  // namespace helixnav::reports
