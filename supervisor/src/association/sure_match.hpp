// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace helixnav::supervisor {

/// By how much a match has to be likelier than all else that the observation may be, to be used where it alone would move the pose, or
/// where what it matches may be a false alarm: 95 % (docs/moving.md, "False alarms", explains the 95).
inline double sure_match_nats() {
  static const double nats = std::log(0.95 / 0.05);
  return nats;
}

}  // namespace helixnav::supervisor
