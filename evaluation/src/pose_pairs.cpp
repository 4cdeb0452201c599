// SPDX-License-Identifier: BSD-3-Clause
#include "pose_pairs.hpp"

#include <algorithm>
#include <map>

#include "run_interpolation.hpp"

namespace helixnav::evaluation {
namespace {

/// The last step not after it.
std::size_t step_before(const std::vector<core::StepReport>& steps, core::Nanoseconds t_ns) {
  const auto after = std::upper_bound(steps.begin(), steps.end(), t_ns,
                                      [](core::Nanoseconds t, const core::StepReport& step) { return t < step.t_ns; });
  return static_cast<std::size_t>(after - steps.begin()) - 1;
}

/// Between the last step of one frame and the first of the next there is no estimate, unless both were brought into one
/// frame.
bool is_torn(const std::vector<core::StepReport>& steps, const std::vector<runs::ReportFrame>& frames, std::size_t step,
             core::Nanoseconds t_ns) {
  if (steps[step].t_ns == t_ns || step + 1 == frames.size() || frames[step].begin == frames[step + 1].begin)
    return false;
  return !frames[step].is_placed || !frames[step + 1].is_placed;
}

}  // namespace

std::vector<PosePair> pose_pairs(const std::vector<core::StepReport>& steps, const std::vector<core::TruePose>& poses,
                                 const std::vector<runs::ReportFrame>& frames) {
  std::vector<PosePair> pairs;
  std::map<std::size_t, std::optional<core::Pose2>> T_report_truth;  // [begin]
  const core::Nanoseconds most_ns = most_apart_ns(steps);
  for (const core::TruePose& known : poses) {
    if (is_in_gap(steps, known.t_ns, most_ns)) continue;
    const auto estimate = estimate_at(steps, known.t_ns);
    if (!estimate) continue;
    const std::size_t step = step_before(steps, known.t_ns);
    if (is_torn(steps, frames, step, known.t_ns)) continue;
    const runs::ReportFrame& frame = frames[step];
    PosePair pair{known, *estimate, frame, known.T_world_robot};
    if (frame.is_moved) pair.known_in_frame.reset();
    if (frame.is_own) {
      const auto [begin, is_first] = T_report_truth.try_emplace(frame.begin);
      if (is_first && step == frame.begin) {
        begin->second = core::compose(estimate->mean, core::inverse(known.T_world_robot));
      }
      pair.known_in_frame = begin->second;
      if (pair.known_in_frame) *pair.known_in_frame = core::compose(*pair.known_in_frame, known.T_world_robot);
    }
    pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace helixnav::evaluation
