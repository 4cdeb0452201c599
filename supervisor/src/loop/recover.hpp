// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include "loop/navigation_loop.hpp"

namespace helixnav::supervisor {

/// The strong guarantee: the call takes effect as a whole, or not at all.
template <class Call>
auto NavigationLoop::all_or_nothing(const Call& call) {
  undo_ = Undo{pending_, tape_.end(), searches_, {}, {}, {}, {}, {}};
  questions_before_ = questions_;
  noise_before_ = noise_;
  try {
    auto result = call();
    commit();
    return result;
  } catch (...) {
    recover();
    throw;
  }
}

}  // namespace helixnav::supervisor
