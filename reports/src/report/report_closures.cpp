// SPDX-License-Identifier: BSD-3-Clause
#include "report_closures.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "helixnav/core/decision_row.hpp"

namespace helixnav::reports {
namespace {

double millimetres(double value) { return std::round(value * 1e3) / 1e3; }

Json pose_json(const core::Pose2& pose) {
  return {millimetres(pose.x_m), millimetres(pose.y_m), millimetres(pose.heading_rad)};
}

bool begins_attempt(const core::Decision& decision) {
  return core::is_trigger(decision) || std::holds_alternative<core::AttemptStarted>(decision);
}

/// The beginning of the attempt that step `k` belongs to.
std::size_t attempt_begin(const std::vector<core::StepReport>& steps, std::size_t k) {
  std::size_t begin = k;
  const auto has_begin = [](const core::StepReport& step) {
    return std::any_of(step.decisions.begin(), step.decisions.end(), begins_attempt);
  };
  while (begin > 0 && !has_begin(steps[begin])) --begin;
  return begin;
}

Json true_pose_json(const runs::RunTruth& truth, core::Nanoseconds t_ns) {
  if (!truth.frame.is_map) return nullptr;
  const auto found = std::lower_bound(truth.poses.begin(), truth.poses.end(), t_ns,
                                      [](const core::TruePose& pose, core::Nanoseconds t) { return pose.t_ns < t; });
  return found != truth.poses.end() && found->t_ns == t_ns ? pose_json(found->T_world_robot) : Json(nullptr);
}

Json view_json(const runs::Run& run, const core::StepReport& step, std::int64_t scans) {
  return {{"scans", scans},
          {"step", step.step},
          {"closing", std::any_of(step.decisions.begin(), step.decisions.end(), core::is_closure)},
          {"estimate", pose_json(step.pose.mean)},
          {"truth", true_pose_json(run.truth, step.t_ns)}};
}

/// Points of the landmarks that were kept, as in the final map.
Json matched_json(const runs::Run& run, const core::StepReport& step) {
  Json matched = Json::array();
  for (const core::MergedLandmarks& merge : step.merged) {
    const auto landmark =
        std::find_if(run.map.begin(), run.map.end(), [&](const core::MapLandmark& l) { return l.id == merge.kept; });
    if (landmark == run.map.end()) continue;
    matched.push_back({millimetres(landmark->point.mean_m.x()), millimetres(landmark->point.mean_m.y())});
  }
  return matched;
}

Json closure_json(const runs::Run& run, std::size_t k, const core::Decision& closure) {
  const std::size_t begin = attempt_begin(run.steps, k);
  Json json = {{"step", run.steps[k].step}, {"verdict", core::row_of(closure).verdict},
               {"views", Json::array()},    {"matched", matched_json(run, run.steps[k])},
               {"winner", nullptr},         {"rival", nullptr}};
  for (std::size_t i = begin; i <= k; ++i) {
    const core::StepReport& step = run.steps[i];
    if (!step.cloud.empty()) json["views"].push_back(view_json(run, step, step.step - run.steps[begin].step));
    for (const core::Decision& decision : step.decisions) {
      const auto* test = std::get_if<core::VerificationDecision>(&decision);
      if (test == nullptr) continue;
      json["winner"] = pose_json(test->T_world_winner);
      json["rival"] = test->rival_matched > 0 ? pose_json(test->T_world_rival) : Json(nullptr);
    }
  }
  return json;
}

}  // namespace

Json closures_data(const runs::Run& run) {
  Json closures = Json::array();
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    for (const core::Decision& decision : run.steps[k].decisions) {
      if (core::is_closure(decision)) closures.push_back(closure_json(run, k, decision));
    }
  }
  return closures;
}

}  // namespace helixnav::reports
