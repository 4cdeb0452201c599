// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include "helixnav/core/recording.hpp"

namespace helixnav::supervisor {

/// Scans of the drive during which nothing is measured.
struct Pause {
  std::size_t from = 0, to = 0;
};

/// The drive without what came in the pauses, when the vehicle was carried. If `is_announced`, an event reports this.
inline core::Recording with_pauses(const core::Recording& run, const std::vector<Pause>& pauses, bool is_announced) {
  core::Recording carried = run;
  carried.events.clear();
  carried.true_poses.clear();
  std::size_t scans = 0;
  bool was_carried = false;
  for (const core::Event& event : run.events) {
    const bool is_carried = std::any_of(pauses.begin(), pauses.end(),
                                        [&](const Pause& pause) { return scans >= pause.from && scans < pause.to; });
    if (is_announced && was_carried && !is_carried) carried.events.emplace_back(core::Lost{core::time_of(event)});
    was_carried = is_carried;
    if (!is_carried) carried.events.push_back(event);
    if (!std::holds_alternative<core::Scan>(event)) continue;
    if (!is_carried) carried.true_poses.push_back(run.true_poses[scans]);
    ++scans;
  }
  return carried;
}

/// Nothing is measured for `time_ns` before the event `at`; it and all later ones are delayed.
inline void wait_before(core::Recording& run, std::size_t at, core::Nanoseconds time_ns) {
  for (std::size_t i = at; i < run.events.size(); ++i) {
    std::visit([&](auto& event) { event.t_ns += time_ns; }, run.events[i]);
  }
}

/// The same events, no more than a second apart (those before `since_ns` unchanged): no clock reveals a pause.
inline core::Recording without_waiting(core::Recording run, core::Nanoseconds since_ns = 0) {
  constexpr core::Nanoseconds longest_ns = 1'000'000'000;
  std::size_t first = 1;
  while (first < run.events.size() && core::time_of(run.events[first]) < since_ns) ++first;
  for (std::size_t i = first; i < run.events.size(); ++i) {
    const core::Nanoseconds passed_ns = core::time_of(run.events[i]) - core::time_of(run.events[i - 1]);
    if (passed_ns > longest_ns) wait_before(run, i, longest_ns - passed_ns);
  }
  return run;
}

}  // namespace helixnav::supervisor
