// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/runs/run.hpp"
#include "json.hpp"

namespace helixnav::reports {

constexpr std::size_t most_particles = 100'000;  ///< of all clouds of a report: 1 MB

/// The clouds of the searches, packed: {"step", "count", "x", "y", "heading"}; lengths in cm, headings in mrad. Thinned
/// equally if there are too many particles.
Json clouds_data(const runs::Run& run);

}  // namespace helixnav::reports
