// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/core/angle.hpp"

namespace helixnav::logs {

inline constexpr double rad_per_deg = core::pi / 180.0;

}  // namespace helixnav::logs
