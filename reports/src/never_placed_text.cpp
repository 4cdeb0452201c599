// SPDX-License-Identifier: BSD-3-Clause
#include "never_placed_text.hpp"

#include <cstddef>
#include <vector>

#include "helixnav/reports/decision_sentence.hpp"
#include "helixnav/runs/report_frame.hpp"

namespace helixnav::reports {

std::string never_placed_text(const runs::Run& run) {
  const std::vector<runs::ReportFrame> frames = runs::report_frames(run);
  std::string spans;
  std::size_t scans = 0;
  for (std::size_t k = 0; k < frames.size();) {
    const std::size_t begin = k;
    while (k < frames.size() && frames[k].is_placed == frames[begin].is_placed) ++k;
    if (frames[begin].is_placed || k == frames.size()) continue;
    scans += k - begin;
    spans += (spans.empty() ? "from " : ", from ") + short_number(core::seconds(run.steps[begin].t_ns)) + " s to " +
             short_number(core::seconds(run.steps[k - 1].t_ns)) + " s";
  }
  if (spans.empty()) return {};
  return spans + " (" + counted(static_cast<double>(scans), "scan") +
         ") the vehicle's place was never found before it was carried on: trajectory_final.tum has that part in a "
         "frame "
         "of its own, and what was mapped there is not on the map";
}

}  // namespace helixnav::reports
