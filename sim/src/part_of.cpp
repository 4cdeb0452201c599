// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/sim/part_of.hpp"

namespace helixnav::sim {
namespace {

core::Recording between(const core::Recording& whole, core::Nanoseconds from_ns, core::Nanoseconds until_ns,
                        bool begins_with_scan) {
  core::Recording part = whole;
  part.events.clear();
  part.labels.clear();
  part.true_poses.clear();
  std::size_t scan = 0;
  for (const core::Event& event : whole.events) {
    const bool is_scan = std::holds_alternative<core::Scan>(event);
    const std::size_t index = scan;
    scan += is_scan ? 1 : 0;
    const core::Nanoseconds t_ns = core::time_of(event);
    const bool begins_later = t_ns < from_ns || (begins_with_scan && part.events.empty() && !is_scan);
    if (begins_later || t_ns > until_ns) continue;
    part.events.push_back(event);
    if (!is_scan) continue;
    if (!whole.labels.empty()) part.labels.push_back(whole.labels[index]);
    if (!whole.true_poses.empty()) part.true_poses.push_back(whole.true_poses[index]);
  }
  return part;
}

}  // namespace

core::Recording part_of(const core::Recording& whole, core::Nanoseconds from_ns, core::Nanoseconds until_ns) {
  return between(whole, from_ns, until_ns, true);
}

core::Recording rest_of(const core::Recording& whole, core::Nanoseconds from_ns, core::Nanoseconds until_ns) {
  return between(whole, from_ns, until_ns, false);
}

}  // namespace helixnav::sim
