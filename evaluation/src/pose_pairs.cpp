// SPDX-License-Identifier: BSD-3-Clause
#include "pose_pairs.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "helixnav/core/interpolate.hpp"
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

/// Of successive times; NaN of fewer than two.
template <class Stamped>
double median_interval_s(const std::vector<Stamped>& stamped) {
  std::vector<double> intervals_s;
  for (std::size_t k = 1; k < stamped.size(); ++k) {
    intervals_s.push_back(core::seconds(stamped[k].t_ns - stamped[k - 1].t_ns));
  }
  if (intervals_s.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = intervals_s.begin() + static_cast<std::ptrdiff_t>(intervals_s.size() / 2);
  std::nth_element(intervals_s.begin(), middle, intervals_s.end());
  return *middle;
}

/// The true pose then, interpolated between two that are no farther apart than that.
std::optional<core::TruePose> truth_at(const std::vector<core::TruePose>& poses, core::Nanoseconds t_ns,
                                       core::Nanoseconds most_ns) {
  const auto after = std::lower_bound(poses.begin(), poses.end(), t_ns,
                                      [](const core::TruePose& pose, core::Nanoseconds t) { return pose.t_ns < t; });
  if (after == poses.end()) return std::nullopt;
  if (after->t_ns == t_ns) return *after;
  if (after == poses.begin()) return std::nullopt;
  const core::TruePose& before = *(after - 1);
  const core::Nanoseconds apart_ns = after->t_ns - before.t_ns;
  if (apart_ns > most_ns) return std::nullopt;
  const double fraction = static_cast<double>(t_ns - before.t_ns) / static_cast<double>(apart_ns);
  return core::TruePose{t_ns, core::interpolate(before.T_world_robot, after->T_world_robot, fraction)};
}

}  // namespace

std::vector<core::TruePose> poses_to_judge(const std::vector<core::StepReport>& steps,
                                           const std::vector<core::TruePose>& poses) {
  constexpr double denser = 0.75;
  if (!(median_interval_s(poses) < denser * median_interval_s(steps))) return poses;
  std::vector<core::TruePose> at_scans;
  const core::Nanoseconds most_ns = most_apart_ns(steps);
  for (const core::StepReport& step : steps) {
    if (const auto known = truth_at(poses, step.t_ns, most_ns)) at_scans.push_back(*known);
  }
  return at_scans;
}

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
