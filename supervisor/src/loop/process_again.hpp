// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <variant>
#include <vector>

#include "loop/navigation_loop.hpp"

namespace helixnav::supervisor {

/// Processes what came in since a checkpoint again, after a rollback to it. Calls after_fix(fix, accepted now) and
/// after_scan(report).
template <class AfterFix, class AfterScan>
void NavigationLoop::process_again(const std::vector<Tape::Entry>& since, const AfterFix& after_fix,
                                   const AfterScan& after_scan) {
  for (const Tape::Entry& entry : since) {
    if (const auto* motion = std::get_if<Tape::Motion>(&entry)) {
      pending_.motion = motion->odometry;
      pending_.driven_m = motion->driven_m;
      pending_.time = motion->time;
    } else if (const auto* fix = std::get_if<Tape::Fix>(&entry)) {
      after_fix(*fix, use_fix(fix->used));
    } else if (const auto* scan = std::get_if<Tape::Scan>(&entry)) {
      after_scan(step(scan->scan));
    }
  }
}

}  // namespace helixnav::supervisor
