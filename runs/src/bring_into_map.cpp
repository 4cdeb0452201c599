// SPDX-License-Identifier: BSD-3-Clause
#include "bring_into_map.hpp"

#include <algorithm>
#include <variant>

namespace helixnav::runs {
namespace {

const core::PlacedDecision* placing_in(const core::StepReport& step) {
  for (const core::Decision& decision : step.decisions) {
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    if (placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::accepted) return placed;
  }
  return nullptr;
}

/// Otherwise the frame was known from the begin, or since it was found before.
bool began_unknown(const Run& run) {
  const auto& decisions = run.steps.front().decisions;
  return std::any_of(decisions.begin(), decisions.end(), [](const core::Decision& decision) {
    const auto* placed = std::get_if<core::PlacedDecision>(&decision);
    return placed != nullptr && placed->verdict == core::PlacedDecision::Verdict::sought;
  });
}

}  // namespace

std::optional<std::size_t> step_of_placing(const Run& run) {
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    if (placing_in(run.steps[k]) != nullptr) return k;
  }
  return std::nullopt;
}

std::optional<core::Pose2> frame_at(const Run& run, core::Nanoseconds t_ns) {
  const std::optional<std::size_t> placing = step_of_placing(run);
  if (!placing || !began_unknown(run) || t_ns >= run.steps[*placing].t_ns) return std::nullopt;
  return placing_in(run.steps[*placing])->T_map_session;
}

namespace {

void move(const core::Pose2& T_map_session, core::MapLandmark& landmark) {
  const Eigen::Matrix2d R = core::rotation(T_map_session.heading_rad);
  landmark.point.mean_m = core::transform(T_map_session, landmark.point.mean_m);
  landmark.point.covariance_m2 = (R * landmark.point.covariance_m2 * R.transpose()).eval();
}

}  // namespace

void bring_into_map(Run& run) {
  const std::optional<std::size_t> placing = step_of_placing(run);
  if (!placing || !began_unknown(run)) return;
  const core::Pose2 T_map_session = placing_in(run.steps[*placing])->T_map_session;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = core::rotation(T_map_session.heading_rad);
  for (std::size_t k = 0; k < *placing; ++k) {
    core::StepReport& step = run.steps[k];
    step.pose.mean = core::compose(T_map_session, step.pose.mean);
    const Eigen::Matrix3d turned = turn * step.pose.covariance * turn.transpose();
    step.pose.covariance = 0.5 * (turned + turned.transpose());
    for (core::Pose2& pose : step.cloud) pose = core::compose(T_map_session, pose);
  }
  for (MapChange& change : run.map_changes) {
    if (change.step >= run.steps[*placing].step) break;
    for (core::MapLandmark& landmark : change.changed) move(T_map_session, landmark);
  }
}

std::vector<core::Pose2> poses_of(const Run& run) {
  std::vector<core::Pose2> poses;
  for (const core::StepReport& step : run.steps) poses.push_back(step.pose.mean);
  return poses;
}

}  // namespace helixnav::runs
