// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/told_frame.hpp"

#include <map>

#include "bring_into_map.hpp"

namespace helixnav::runs {

std::vector<ToldFrame> told_frames(const Run& run) {
  const std::vector<FrameOfStep> frames = frames_of(run);
  std::vector<ToldFrame> told(frames.size());
  if (frames.empty()) return told;
  const int of_truth = began_off_earlier_map(run) && !is_on_earlier_map(run) ? 1 : 0;
  std::map<int, std::size_t> begin_of;  // [part]
  for (std::size_t k = 0; k < frames.size(); ++k) {
    told[k].begin = begin_of.try_emplace(frames[k].told_part, k).first->second;
    told[k].is_own = frames[k].told_part != of_truth;
    told[k].is_placed = frames[k].part == of_truth;
    told[k].is_moved = !told[k].is_own && !frames[k].T_final_told.vector().isZero(0.0);
  }
  return told;
}

}  // namespace helixnav::runs
