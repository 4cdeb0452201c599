// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

#include "bind.hpp"
#include "gil.hpp"

namespace helixnav::python {

/// Ctrl-C in a call that takes long and holds no GIL: to be asked as often as one likes, it looks five times a second.
class SignalWatch {
 public:
  /// Throws what Python's handler raises, KeyboardInterrupt by default.
  void heed() {
    const Clock::time_point now = Clock::now();
    if (now - last_ < std::chrono::milliseconds(200)) return;
    last_ = now;
    const WithGil acquired;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace helixnav::python
