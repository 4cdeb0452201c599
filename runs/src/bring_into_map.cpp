// SPDX-License-Identifier: BSD-3-Clause
#include "bring_into_map.hpp"

#include <algorithm>
#include <variant>

namespace helixnav::runs {
namespace {

const core::PlacedDecision* placing_in(const core::Decision& decision) {
  const auto* placed = std::get_if<core::PlacedDecision>(&decision);
  return placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted ? placed : nullptr;
}

void move(const core::Pose2& T_final_reported, core::MapLandmark& landmark) {
  const Eigen::Matrix2d R = core::rotation(T_final_reported.heading_rad);
  landmark.point.mean_m = core::transform(T_final_reported, landmark.point.mean_m);
  landmark.point.covariance_m2 = (R * landmark.point.covariance_m2 * R.transpose()).eval();
}

void move(const core::Pose2& T_final_reported, core::StepReport& step) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = core::rotation(T_final_reported.heading_rad);
  step.pose.mean = core::compose(T_final_reported, step.pose.mean);
  const Eigen::Matrix3d turned = turn * step.pose.covariance * turn.transpose();
  step.pose.covariance = 0.5 * (turned + turned.transpose());
  for (core::Pose2& pose : step.cloud) pose = core::compose(T_final_reported, pose);
}

/// Up to a place that turned out to be wrong and beyond it, the part is solved in the frame with which it began.
void drive_again(const core::Pose2& T_final_part, std::size_t first, std::vector<FrameOfStep>& frames) {
  for (std::size_t k = first; k < frames.size(); ++k) frames[k].T_final_solved = T_final_part;
}

}  // namespace

bool has_found_place(const Run& run) {
  return std::any_of(run.steps.begin(), run.steps.end(), [](const core::StepReport& step) {
    return std::any_of(step.decisions.begin(), step.decisions.end(),
                       [](const core::Decision& decision) { return placing_in(decision) != nullptr; });
  });
}

std::vector<FrameOfStep> frames_of(const Run& run) {
  std::vector<FrameOfStep> frames;
  if (run.steps.empty()) return frames;
  int part = began_off_earlier_map(run) ? 1 : 0;  // part 0: that map
  int times_carried = 0;
  for (const core::StepReport& step : run.steps) {
    core::Pose2 T_reported_solved;
    for (const core::Decision& decision : step.decisions) {
      if (const auto* carried = std::get_if<core::CarriedDecision>(&decision)) {
        part = carried->part;
        ++times_carried;
        const std::size_t scans = std::min(frames.size(), static_cast<std::size_t>(std::max(0, carried->scans)));
        const std::size_t first = frames.size() - scans;
        for (std::size_t k = first; k < frames.size(); ++k) {
          frames[k].part = part;
          frames[k].times_carried = times_carried;
        }
        if (carried->cause == core::CarriedDecision::Cause::wrong_place && scans > 0) {
          drive_again(frames[first].T_final_solved, first, frames);
          T_reported_solved = frames[first].T_final_solved;
        }
      }
      const core::PlacedDecision* placing = placing_in(decision);
      if (placing == nullptr || placing->part == part) continue;
      for (std::size_t k = 0; k < frames.size(); ++k) {
        if (frames[k].part != part) continue;
        frames[k].part = placing->part;
        frames[k].T_final_reported = core::compose(placing->T_map_session, frames[k].T_final_reported);
        frames[k].T_final_solved = core::compose(placing->T_map_session, frames[k].T_final_solved);
      }
      T_reported_solved = core::compose(placing->T_map_session, T_reported_solved);
      part = placing->part;
    }
    frames.push_back({times_carried, part, part, {}, T_reported_solved});
  }
  return frames;
}

void bring_into_map(Run& run) {
  if (!has_found_place(run)) return;
  const std::vector<FrameOfStep> frames = frames_of(run);
  const auto stays = [](const FrameOfStep& frame) { return frame.T_final_reported.vector().isZero(0.0); };
  auto change = run.map_changes.begin();
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const core::Pose2& T_final_reported = frames[k].T_final_reported;
    for (; change != run.map_changes.end() && change->step <= run.steps[k].step; ++change) {
      if (stays(frames[k])) continue;
      for (core::MapLandmark& landmark : change->changed) move(T_final_reported, landmark);
    }
    if (!stays(frames[k])) move(T_final_reported, run.steps[k]);
  }
}

std::vector<core::Pose2> poses_of(const Run& run) {
  std::vector<core::Pose2> poses;
  for (const core::StepReport& step : run.steps) poses.push_back(step.pose.mean);
  return poses;
}

}  // namespace helixnav::runs
