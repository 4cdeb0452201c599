// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::supervisor {

/// Landmarks that move are found out and dropped. Figures: docs/slips.md.
struct MovingOptions {
  bool enabled = true;
  double speed_mps =
      5.0;  ///< standard deviation of a velocity, along each axis, for a sensor of reference_reach_m (lengths.hpp)
  double nats =
      11.5;  ///< "it moves" must explain its sightings better than "it stands" by so much: a hundred thousand to one
};

}  // namespace helixnav::supervisor
