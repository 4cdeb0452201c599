// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

namespace helixnav::association {

// Costs are negative log densities, in nats.
inline constexpr double ln_2pi = 1.8378770664093454836;
inline constexpr double infinity = std::numeric_limits<double>::infinity();  ///< of what is forbidden or not reached

}  // namespace helixnav::association
