// SPDX-License-Identifier: BSD-3-Clause
#include "systematic/spaced_out.hpp"

#include <optional>

#include "helixnav/core/odometry.hpp"

namespace helixnav::supervisor {

std::vector<Stop> spaced_out(const std::vector<Stop>& stops, double least_m) {
  std::vector<Stop> chosen;
  std::optional<core::Odometry> motion;
  for (const Stop& stop : stops) {
    if (stop.motion) motion = motion ? core::chain(*motion, *stop.motion) : *stop.motion;
    const bool is_far = motion && motion->T_before_after.position_m().norm() >= least_m;
    if (!chosen.empty() && !is_far) continue;
    chosen.push_back(stop);
    chosen.back().motion = chosen.size() > 1 ? motion : std::nullopt;
    motion.reset();
  }
  return chosen;
}

}  // namespace helixnav::supervisor
