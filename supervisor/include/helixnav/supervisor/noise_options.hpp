// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::supervisor {

/// Whether the covariances reported by odometry and detector are used as given or multiplied by factors learnt while
/// driving. Figures: docs/slips.md.
struct NoiseOptions {
  bool adapt = true;
};

}  // namespace helixnav::supervisor
