// SPDX-License-Identifier: BSD-3-Clause
#include "lasting_matches.hpp"

#include <map>
#include <optional>
#include <utility>
#include <variant>

#include <Eigen/Cholesky>

#include "helixnav/core/merged_ids.hpp"

namespace helixnav::apps {
namespace {

constexpr double outlier_nis = 30.0;  // one in 3 million
constexpr double nearest_m = 1e-3;    // nothing is seen at such a short range

std::optional<LastingMatch> match_of(const core::Observation& seen, const core::Pose2& T_world_robot,
                                     const core::Pose2& T_robot_sensor, const Eigen::Vector2d& point_m) {
  if (seen.kind != core::ObservationKind::range_bearing) return std::nullopt;
  const Eigen::Vector2d sensor_m = core::compose(T_world_robot, T_robot_sensor).position_m();
  if (!((point_m - sensor_m).norm() > nearest_m)) return std::nullopt;
  LastingMatch match;
  match.T_robot_sensor = T_robot_sensor;
  match.R_lower = Eigen::LLT<Eigen::Matrix2d>(Eigen::Matrix2d(seen.R)).matrixL();
  match.predicted = core::predict_observation(seen.kind, T_world_robot, T_robot_sensor, point_m);
  match.residual = core::innovation(seen.kind, seen.z, match.predicted.z_hat);
  const Eigen::Vector2d whitened = match.R_lower.triangularView<Eigen::Lower>().solve(match.residual);
  if (!(whitened.squaredNorm() < outlier_nis)) return std::nullopt;
  return match;
}

/// Where the landmarks that lasted are, by id.
std::map<core::LandmarkId, std::pair<std::size_t, Eigen::Vector2d>> mature_points(const runs::Run& run) {
  std::map<core::LandmarkId, std::pair<std::size_t, Eigen::Vector2d>> points;
  for (const core::MapLandmark& landmark : run.map) {
    if (landmark.state != core::LandmarkState::mature) continue;
    points.emplace(landmark.id, std::pair(points.size(), landmark.point.mean_m));
  }
  return points;
}

}  // namespace

std::vector<LastingMatch> lasting_matches(const core::Recording& recording, const runs::Run& run) {
  const auto points = mature_points(run);
  const core::MergedIds merged(run.steps);
  std::vector<LastingMatch> matches;
  std::size_t k = 0;
  for (const core::Event& event : recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    if (k >= run.steps.size()) break;
    const core::Pose2& T_world_robot = k < run.final_path.size() ? run.final_path[k] : run.steps[k].pose.mean;
    for (const core::AssociationReport& a : run.steps[k].associations) {
      const bool used = a.outcome == core::Outcome::matched || a.outcome == core::Outcome::augmented;
      const auto i = static_cast<std::size_t>(a.observation);
      if (!used || i >= scan->observations.size()) continue;
      const auto landmark = points.find(merged.now(a.landmark));
      if (landmark == points.end()) continue;
      auto match = match_of(scan->observations[i], T_world_robot, scan->T_robot_sensor, landmark->second.second);
      if (!match) continue;
      match->scan = k;
      match->landmark = landmark->second.first;
      matches.push_back(*match);
    }
    ++k;
  }
  return matches;
}

}  // namespace helixnav::apps
