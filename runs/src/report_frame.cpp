// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/report_frame.hpp"

#include <map>

#include "bring_into_map.hpp"

namespace helixnav::runs {

std::vector<ReportFrame> report_frames(const Run& run) {
  const std::vector<FrameOfStep> frames = frames_of(run);
  std::vector<ReportFrame> reported(frames.size());
  if (frames.empty()) return reported;
  const int of_truth = began_off_earlier_map(run) && !is_on_earlier_map(run) ? 1 : 0;
  std::map<int, std::size_t> begin_of;  // [part]
  for (std::size_t k = 0; k < frames.size(); ++k) {
    reported[k].begin = begin_of.try_emplace(frames[k].reported_part, k).first->second;
    reported[k].is_own = frames[k].reported_part != of_truth;
    reported[k].is_placed = frames[k].part == of_truth;
    reported[k].is_moved = !reported[k].is_own && !frames[k].T_final_reported.vector().isZero(0.0);
    if (!reported[k].is_moved) continue;
    const Eigen::Vector2d now_m = run.steps[k].pose.mean.position_m();
    reported[k].moved_m = (core::transform(core::inverse(frames[k].T_final_reported), now_m) - now_m).norm();
  }
  return reported;
}

}  // namespace helixnav::runs
