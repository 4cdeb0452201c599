// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/runs/run.hpp"

namespace helixnav::runs {

/// Whether the run is one of replay --localize, which maps nothing: its map is the given one.
bool only_localized(const Run& run);

}  // namespace helixnav::runs
