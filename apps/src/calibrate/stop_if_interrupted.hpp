// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/interrupt.hpp"

namespace helixnav::apps {

/// Unwinds everything in progress; not a std::exception, so that nobody takes it for a failure.
struct Interrupted {};

/// To be called at least twice a second (common/interrupt.hpp).
inline void stop_if_interrupted() {
  if (interrupted()) throw Interrupted();
}

}  // namespace helixnav::apps
