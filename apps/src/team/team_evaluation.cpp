// SPDX-License-Identifier: BSD-3-Clause
#include "team/team_evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <Eigen/Cholesky>

#include "helixnav/evaluation/alignment.hpp"

namespace helixnav::apps {
namespace {

/// Between the true poses around t_ns, half a second apart at most.
std::optional<core::Pose2> true_pose_at(const std::vector<core::TruePose>& truth, core::Nanoseconds t_ns) {
  constexpr core::Nanoseconds most_ns = 500'000'000;
  const auto after = std::upper_bound(truth.begin(), truth.end(), t_ns,
                                      [](core::Nanoseconds t, const core::TruePose& pose) { return t < pose.t_ns; });
  if (after == truth.begin()) return std::nullopt;
  const core::TruePose& before = *std::prev(after);
  if (before.t_ns == t_ns) return before.T_world_robot;
  if (after == truth.end() || after->t_ns - before.t_ns > most_ns) return std::nullopt;
  const double share = core::seconds(t_ns - before.t_ns) / core::seconds(after->t_ns - before.t_ns);
  const Eigen::Vector3d way = core::between(before.T_world_robot, after->T_world_robot).vector();
  return core::compose(before.T_world_robot, core::Pose2(Eigen::Vector3d(share * way)));
}

double rms(const std::vector<double>& errors) {
  double sum = 0.0;
  for (const double error : errors) sum += error * error;
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

constexpr double any_distance_m = 1e6;

std::vector<double> aligned_errors(const std::vector<Eigen::Vector2d>& truth_m,
                                   const std::vector<Eigen::Vector2d>& at_m) {
  const core::Pose2 T = evaluation::align_rigidly(truth_m, at_m, any_distance_m).T_a_b;
  std::vector<double> errors;
  for (std::size_t i = 0; i < at_m.size(); ++i) errors.push_back((core::transform(T, at_m[i]) - truth_m[i]).norm());
  return errors;
}

std::optional<RobotErrors> errors_of(const TeamTask& task, const TeamDrive::Robot& robot,
                                     const core::Recording& recording) {
  const std::optional<core::Pose2> T_component_truth = frame_of_truth(task, robot.component);
  if (!T_component_truth || recording.true_poses.empty()) return std::nullopt;
  std::vector<Eigen::Vector2d> truth_m, at_m;
  std::vector<double> raw;
  int in_frame = 0;
  RobotErrors errors;
  for (std::size_t k = 0; k < robot.steps.size(); ++k) {
    const std::optional<core::Pose2> truth = true_pose_at(recording.true_poses, robot.steps[k].t_ns);
    if (robot.at[k] == 0 || !truth) continue;
    const core::Pose2 T = core::compose(*T_component_truth, *truth);
    const core::PoseGaussian& pose = robot.steps[k].pose;
    truth_m.push_back(T.position_m());
    at_m.push_back(pose.mean.position_m());
    raw.push_back((at_m.back() - truth_m.back()).norm());
    if (robot.steps[k].t_ns < robot.in_frame_since_ns) continue;
    ++in_frame;
    Eigen::Vector3d e = pose.mean.vector() - T.vector();
    e[2] = core::wrap_to_pi(e[2]);
    constexpr double floor = 1e-8;  // m², rad²
    errors.nees_mean += e.dot((pose.covariance + floor * Eigen::Matrix3d::Identity()).ldlt().solve(e));
  }
  if (raw.empty()) return std::nullopt;
  errors.nees_mean /= in_frame;  // NaN where the robot came into its frame after its last scan with truth
  errors.raw_m = evaluation::error_statistics(raw);
  errors.aligned_m = evaluation::error_statistics(aligned_errors(truth_m, at_m));
  return errors;
}

/// Landmarks of the component that some robot knows by the label.
std::map<core::LandmarkId, core::Label> labels_in(const TeamTask& task, const TeamDrive& drive, int component) {
  std::map<core::LandmarkId, core::Label> labels;
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    if (drive.robots[r].component != component) continue;
    for (const core::TrueLandmark& landmark : task.recording.true_landmarks) {
      const core::LandmarkId id = drive.team.landmark_of(static_cast<int>(r), landmark.label);
      if (id != core::no_landmark) labels[id] = landmark.label;
    }
  }
  return labels;
}

std::optional<LandmarkErrors> landmark_errors(const TeamTask& task, const TeamDrive& drive, int component) {
  const std::map<core::LandmarkId, core::Label> labels = labels_in(task, drive, component);
  std::map<core::Label, Eigen::Vector2d> true_m;
  for (const core::TrueLandmark& landmark : task.recording.true_landmarks) true_m[landmark.label] = landmark.point_m;
  std::vector<Eigen::Vector2d> truth_m, at_m;
  for (const core::MapLandmark& landmark : drive.team.map(component)) {
    const auto label = labels.find(landmark.id);
    if (label == labels.end() || landmark.state != core::LandmarkState::mature) continue;
    truth_m.push_back(true_m.at(label->second));
    at_m.push_back(landmark.point.mean_m);
  }
  if (at_m.size() < 2) return std::nullopt;
  LandmarkErrors errors{component, at_m.size(), std::numeric_limits<double>::quiet_NaN(), 0.0};
  errors.aligned_rmse_m = rms(aligned_errors(truth_m, at_m));
  if (const std::optional<core::Pose2> T = frame_of_truth(task, component)) {
    std::vector<double> raw;
    for (std::size_t i = 0; i < at_m.size(); ++i) raw.push_back((at_m[i] - core::transform(*T, truth_m[i])).norm());
    errors.raw_rmse_m = rms(raw);
  }
  return errors;
}

}  // namespace

std::optional<core::Pose2> frame_of_truth(const TeamTask& task, int component) {
  if (!task.unknown_starts) return core::Pose2();
  const core::Recording& first = task.recording.robots[static_cast<std::size_t>(component)].recording;
  if (first.true_poses.empty()) return std::nullopt;
  return core::inverse(first.start.mean);
}

TeamEvaluation evaluate_team(const TeamTask& task, const TeamDrive& drive) {
  TeamEvaluation evaluation;
  std::set<int> components;
  for (std::size_t r = 0; r < drive.robots.size(); ++r) {
    evaluation.robots.push_back(errors_of(task, drive.robots[r], task.recording.robots[r].recording));
    components.insert(drive.robots[r].component);
  }
  for (const int component : components) {
    if (!task.known_association) break;
    const std::optional<LandmarkErrors> errors = landmark_errors(task, drive, component);
    if (errors) evaluation.landmarks.push_back(*errors);
  }
  return evaluation;
}

}  // namespace helixnav::apps
