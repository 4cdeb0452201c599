// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/runs/run.hpp"
#include "json.hpp"

namespace helixnav::reports {

/// What the report shows for each closure: where the clouds of the attempt that led to it are (clouds_data, by step),
/// the constellation that was matched, and where it would be under the best rival. Lengths to 1 mm, map frame.
Json closures_data(const runs::Run& run);

}  // namespace helixnav::reports
