// SPDX-License-Identifier: BSD-3-Clause
#include "keep_scans.hpp"

#include <algorithm>
#include <variant>

namespace helixnav::apps {
namespace {

bool is_scan_event(const core::Event& event) { return std::holds_alternative<core::Scan>(event); }

}  // namespace

std::size_t scans_of(const core::Recording& recording) {
  return static_cast<std::size_t>(std::count_if(recording.events.begin(), recording.events.end(), is_scan_event));
}

void keep_scans(core::Recording& recording, std::size_t most) {
  std::size_t scans = 0;
  auto end = recording.events.begin();
  for (auto event = end; event != recording.events.end() && scans < most; ++event) {
    scans += is_scan_event(*event) ? 1 : 0;
    end = event + 1;
  }
  if (scans < most) return;
  recording.events.erase(end, recording.events.end());
  if (recording.labels.size() > most) recording.labels.resize(most);
}

}  // namespace helixnav::apps
