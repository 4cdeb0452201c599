// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/interrupt.hpp"

namespace helixnav::apps {

/// Thrown through everything that was begun; no std::exception, so that nobody takes it for a failure.
struct Interrupted {};

/// To be asked at least twice a second (common/interrupt.hpp).
inline void stop_if_interrupted() {
  if (interrupted()) throw Interrupted();
}

}  // namespace helixnav::apps
