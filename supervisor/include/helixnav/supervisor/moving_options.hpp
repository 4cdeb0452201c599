// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::supervisor {

/// Moving landmarks are detected and dropped. Figures: docs/moving.md.
struct MovingOptions {
  bool enabled = true;
  double speed_mps =
      5.0;  ///< velocity standard deviation along each axis, for a sensor of reach reference_reach_m (lengths.hpp)
  double nats =
      11.5;  ///< "it moves" must explain its sightings better than "it stands" by this: a hundred thousand to one
};

}  // namespace helixnav::supervisor
