// SPDX-License-Identifier: BSD-3-Clause
#include "own_overlap.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <variant>

namespace helixnav::logs {
namespace {

/// Scans on one side of the odometry.
struct OutsideScans {
  std::size_t count = 0;
  core::Nanoseconds first_ns = 0, last_ns = 0;

  void add(core::Nanoseconds t_ns) {
    if (count++ == 0) first_ns = t_ns;
    last_ns = t_ns;
  }
  void tell(const char* where, const char* how, std::vector<std::string>& doubts) const {
    if (count == 0) return;
    std::array<char, 320> text{};
    std::snprintf(text.data(), text.size(), "%zu %s taken %s (%.9g to %.9g s): %s", count,
                  count == 1 ? "scan was" : "scans were", where, core::seconds(first_ns), core::seconds(last_ns), how);
    doubts.emplace_back(text.data());
  }
};

}  // namespace

core::Nanoseconds mean_interval_ns(core::Nanoseconds first_ns, core::Nanoseconds last_ns, std::size_t rows) {
  return rows < 2 ? 0 : (last_ns - first_ns) / static_cast<core::Nanoseconds>(rows - 1);
}

core::Nanoseconds told_until_ns(core::Nanoseconds first_ns, core::Nanoseconds last_ns, std::size_t rows) {
  return last_ns + mean_interval_ns(first_ns, last_ns, rows);
}

void doubt_overlap(const OwnLog& log, const core::Recording& recording, std::vector<std::string>& doubts) {
  const core::Nanoseconds begin_ns = log.odometry.front().t_ns, end_ns = log.odometry.back().t_ns;
  const core::Nanoseconds usual_ns = mean_interval_ns(begin_ns, end_ns, log.odometry.size());
  OutsideScans before, after;
  for (const core::Event& event : recording.events) {
    if (!std::holds_alternative<core::Scan>(event)) continue;
    const core::Nanoseconds t_ns = core::time_of(event);
    if (t_ns < begin_ns - usual_ns) before.add(t_ns);
    if (t_ns > end_ns + usual_ns) after.add(t_ns);
  }
  before.tell("before the odometry begins", "the vehicle is taken to have stood until then", doubts);
  after.tell("after the odometry ends", "its last row is held until then, less certain the longer", doubts);
}

}  // namespace helixnav::logs
