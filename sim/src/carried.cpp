// SPDX-License-Identifier: BSD-3-Clause
#include "carried.hpp"

#include "helixnav/core/random.hpp"

namespace helixnav::sim {

std::vector<Stretch> draw_carried(const CarryOptions& options, double drive_m, std::uint64_t seed) {
  std::vector<Stretch> carried;
  if (options.every_m <= 0.0) return carried;
  core::RandomStream random(seed, "sim.carried");
  double at_m = 0.0;
  while (true) {
    at_m += options.every_m * random.uniform(0.75, 1.25);
    const double distance_m = random.uniform(options.distance_m.min, options.distance_m.max);
    if (at_m + distance_m >= drive_m) return carried;
    carried.push_back({at_m, at_m + distance_m});
    at_m += distance_m;
  }
}

}  // namespace helixnav::sim
