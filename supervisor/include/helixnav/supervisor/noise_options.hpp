// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::supervisor {

/// What is learnt of odometry and detector while driving.
struct NoiseOptions {
  bool adapt = true;       ///< factors on the covariances that they report (docs/noise.md); false: as reported
  bool systematic = true;  ///< errors that they make throughout (docs/systematic.md); false: there are none
};

}  // namespace helixnav::supervisor
