// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace helixnav::core {

/// Name of a landmark in one map. Given in order of birth from 0, never used again after removal.
using LandmarkId = std::int32_t;

/// "No landmark" in tables and files.
inline constexpr LandmarkId no_landmark = -1;

}  // namespace helixnav::core
