// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "helixnav/core/particle_cloud.hpp"

namespace helixnav::runs {

/// A row of particles.csv.
void append_particles(std::string& text, std::int64_t step, const core::CloudReport& cloud);

/// All of paths.csv, of mixture.csv.
std::string paths_text(const std::vector<core::PathPoint>& paths);
std::string mixture_text(const std::vector<core::MixedLandmark>& mixture);

}  // namespace helixnav::runs
