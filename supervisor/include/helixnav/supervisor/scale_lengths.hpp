// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/supervisor/search_options.hpp"

namespace helixnav::supervisor {

/// The search for a world seen at another scale: every length that has to do with what the sensor sees at once (looks,
/// tests, modes, places, the reach of the reference map, a landmark's noise) times `scale`, areas' densities divided by
/// its square. The defaults belong to a sensor that sees 30 m far; one that sees 3 m has scale 0.1. Distances that say
/// how long a question may stay open are left alone. Test: supervisor/scale_lengths_test.cpp; judged by the labels of the
/// DLR log in docs/ihgr.md.
SearchOptions scale_lengths(SearchOptions search, double scale);

}  // namespace helixnav::supervisor
