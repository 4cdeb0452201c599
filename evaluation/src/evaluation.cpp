// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/evaluation/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "evaluation_map.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/rigid_fit.hpp"
#include "helixnav/evaluation/alignment.hpp"
#include "helixnav/evaluation/nees.hpp"
#include "helixnav/runs/only_localized.hpp"
#include "helixnav/runs/report_frame.hpp"
#include "pose_pairs.hpp"
#include "run_interpolation.hpp"

namespace helixnav::evaluation {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Band {
  double low;
  double high;
  bool holds(double value) const { return value >= low && value <= high; }
};

Band two_sided_95(int dof) { return {core::chi2_quantile(0.025, dof), core::chi2_quantile(0.975, dof)}; }

double fraction_of(std::size_t part, std::size_t whole) {
  return whole == 0 ? nan : static_cast<double>(part) / static_cast<double>(whole);
}

Eigen::Vector2d sigma_of_point(const core::PoseGaussian& pose, const Eigen::Vector2d& point_robot_m) {
  Eigen::Matrix<double, 2, 3> J = Eigen::Matrix<double, 2, 3>::Identity();
  const Eigen::Vector2d arm = core::rotation(pose.mean.heading_rad) * point_robot_m;
  J.col(2) << -arm.y(), arm.x();
  return (J * pose.covariance * J.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
}

ErrorStatistics statistics_of_used(const std::vector<PositionError>& errors) {
  std::vector<double> norms;
  for (const PositionError& error : errors) {
    if (error.used) norms.push_back(error.error_m.norm());
  }
  return error_statistics(std::move(norms));
}

using Steps = std::vector<core::StepReport>;

PositionEvaluation evaluate_positions(const Steps& steps, const runs::RunTruth& truth, double limit_m) {
  PositionEvaluation result;
  result.aligned = true;
  result.limit_m = limit_m;
  std::vector<Eigen::Vector2d> fixes;
  std::vector<Eigen::Vector2d> antennas;
  const core::Nanoseconds most_ns = most_apart_ns(steps);
  result.gap_s = core::seconds(most_ns);
  for (const core::TruePosition& fix : truth.positions) {
    if (is_in_gap(steps, fix.t_ns, most_ns)) {
      ++result.fixes_in_gaps;
      continue;
    }
    const auto pose = estimate_at(steps, fix.t_ns);
    if (!pose) {
      ++result.fixes_outside;
      continue;
    }
    fixes.push_back(fix.position_m);
    antennas.push_back(core::transform(pose->mean, truth.antenna_robot_m));
    PositionError& error = result.errors.emplace_back();
    error.t_ns = fix.t_ns;
    error.sigma_m = sigma_of_point(*pose, truth.antenna_robot_m);
  }
  const RigidAlignment alignment = align_rigidly(fixes, antennas, limit_m);
  result.T_truth_map = alignment.T_a_b;
  const core::Pose2 T_map_truth = core::inverse(alignment.T_a_b);
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    PositionError& error = result.errors[i];
    error.true_map_m = core::transform(T_map_truth, fixes[i]);
    error.error_m = antennas[i] - error.true_map_m;
    error.used = alignment.used[i];
  }
  result.fixes_used = static_cast<std::size_t>(alignment.used_count);
  result.fixes_left_out = fixes.size() - result.fixes_used;
  result.error_m = statistics_of_used(result.errors);
  return result;
}

void summarize_poses(PoseEvaluation& result) {
  const Band band = two_sided_95(3);
  std::vector<double> headings;
  std::size_t inside = 0;
  double sum = 0.0;
  for (const HeadingError& error : result.errors) {
    headings.push_back(std::abs(error.error_rad));
    if (!std::isfinite(error.nees)) continue;
    ++result.nees_count;
    sum += error.nees;
    inside += band.holds(error.nees) ? 1 : 0;
  }
  result.heading_error_rad = error_statistics(std::move(headings));
  result.nees_mean = result.nees_count == 0 ? nan : sum / static_cast<double>(result.nees_count);
  result.nees_inside_95 = fraction_of(inside, result.nees_count);
}

/// Rigid alignment of everything in one frame; returns the RMSE of the remaining position errors.
std::pair<core::Pose2, double> align_poses(const std::vector<PosePair>& pairs) {
  std::vector<Eigen::Vector2d> known_m;
  std::vector<Eigen::Vector2d> estimated_m;
  for (const PosePair& pair : pairs) {
    if (!pair.frame.is_placed) continue;
    known_m.push_back(pair.known.T_world_robot.position_m());
    estimated_m.push_back(pair.estimate.mean.position_m());
  }
  const core::Pose2 T_truth_map = core::fit_rigidly(known_m, estimated_m);
  std::vector<double> left_m;
  for (std::size_t i = 0; i < known_m.size(); ++i) {
    left_m.push_back((known_m[i] - core::transform(T_truth_map, estimated_m[i])).norm());
  }
  return {T_truth_map, error_statistics(std::move(left_m)).rmse};
}

Eigen::Vector3d error_of(const core::Pose2& estimate, const core::Pose2& known) {
  Eigen::Vector3d error = estimate.vector() - known.vector();
  error.z() = core::wrap_to_pi(error.z());
  return error;
}

/// Counts what it is compared with.
double nees_of(const PosePair& pair, const core::Pose2& known_map, PoseEvaluation& pose) {
  if (!pair.known_in_frame) {
    ++pose.nees_left_out;
    return nan;
  }
  pose.nees_in_own_frame += pair.frame.is_own ? 1 : 0;
  return nees(pair.estimate, pair.frame.is_own ? *pair.known_in_frame : known_map);
}

std::pair<PositionEvaluation, PoseEvaluation> evaluate_poses(const Steps& steps, const runs::RunTruth& truth,
                                                             const std::vector<runs::ReportFrame>& frames,
                                                             core::Nanoseconds nees_from_ns) {
  PositionEvaluation position;
  position.limit_m = std::numeric_limits<double>::infinity();
  position.against_poses = true;
  position.aligned = !truth.frame.is_map;
  PoseEvaluation pose;
  const std::vector<core::TruePose> poses = poses_to_judge(steps, truth.poses);
  const std::vector<PosePair> pairs = pose_pairs(steps, poses, frames);
  const auto [T_truth_map, rmse_m] = align_poses(pairs);
  position.rmse_aligned_m = rmse_m;
  if (position.aligned) position.T_truth_map = T_truth_map;
  const core::Pose2 T_map_truth = core::inverse(position.T_truth_map);
  for (const PosePair& pair : pairs) {
    if (!pair.frame.is_placed && !pair.known_in_frame) continue;
    core::Pose2 known =
        position.aligned ? core::compose(T_map_truth, pair.known.T_world_robot) : pair.known.T_world_robot;
    const bool counts = pair.known.t_ns >= nees_from_ns;
    const double own_nees = counts ? nees_of(pair, known, pose) : nan;
    if (!pair.frame.is_placed) known = *pair.known_in_frame;
    const Eigen::Vector3d error = error_of(pair.estimate.mean, known);
    const Eigen::Vector3d sigma = pair.estimate.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
    position.errors.push_back({pair.known.t_ns, known.position_m(), error.head<2>(), sigma.head<2>(), true});
    pose.errors.push_back({pair.known.t_ns, error.z(), sigma.z(), own_nees});
  }
  position.fixes_used = position.errors.size();
  const core::Nanoseconds most_ns = most_apart_ns(steps);
  position.gap_s = core::seconds(most_ns);
  for (const runs::ReportFrame& frame : frames) {
    position.steps_moved += frame.is_moved ? 1 : 0;
    position.moved_m = std::max(position.moved_m, frame.moved_m);
  }
  for (const core::TruePose& known : poses) position.fixes_in_gaps += is_in_gap(steps, known.t_ns, most_ns) ? 1 : 0;
  position.fixes_outside = poses.size() - position.fixes_used - position.fixes_in_gaps;
  position.error_m = statistics_of_used(position.errors);
  summarize_poses(pose);
  return {std::move(position), std::move(pose)};
}

/// Times and poses of the final path, in the form of steps.
Steps final_steps(const runs::Run& run) {
  Steps steps(run.final_path.size());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    steps[i].t_ns = run.steps[i].t_ns;
    steps[i].pose = {run.final_path[i], run.steps[i].pose.covariance};
  }
  return steps;
}

std::optional<PositionEvaluation> evaluate_final(const runs::Run& run, const runs::RunTruth& truth, double limit_m) {
  if (run.final_path.empty() || run.final_path.size() != run.steps.size()) return std::nullopt;
  const Steps steps = final_steps(run);
  if (!truth.positions.empty()) return evaluate_positions(steps, truth, limit_m);
  if (truth.poses.empty()) return std::nullopt;
  return evaluate_poses(steps, truth, runs::report_frames(run), EvaluationOptions().nees_from_ns).first;
}

NisEvaluation evaluate_nis(const std::vector<core::StepReport>& steps) {
  NisEvaluation result;
  std::map<int, Band> bands;
  std::size_t inside = 0;
  double nis = 0.0;
  double dof = 0.0;
  for (const core::StepReport& step : steps) {
    if (step.joint_dof < 1) continue;
    const auto band = bands.try_emplace(step.joint_dof, Band{}).first;
    if (band->second.high == 0.0) band->second = two_sided_95(step.joint_dof);
    ++result.updates;
    inside += band->second.holds(step.joint_nis) ? 1 : 0;
    nis += step.joint_nis;
    dof += step.joint_dof;
  }
  result.inside_95 = fraction_of(inside, result.updates);
  result.mean_per_dof = result.mean_low_95 = result.mean_high_95 = nan;
  if (result.updates == 0) return result;
  const Band of_sum = two_sided_95(static_cast<int>(dof));
  result.mean_per_dof = nis / dof;
  result.mean_low_95 = of_sum.low / dof;
  result.mean_high_95 = of_sum.high / dof;
  return result;
}

RevisitEvaluation evaluate_revisits(const std::vector<core::StepReport>& steps) {
  RevisitEvaluation result;
  std::map<core::LandmarkId, std::int64_t> last_seen;
  double nis = 0.0;
  double dof = 0.0;
  for (const core::StepReport& step : steps) {
    for (const core::AssociationReport& a : step.associations) {
      if (a.outcome != core::Outcome::matched && a.outcome != core::Outcome::augmented) continue;
      const auto [seen, first] = last_seen.try_emplace(a.landmark, step.step);
      if (!first && a.dof > 0 && step.step - seen->second > RevisitEvaluation::unseen_steps) {
        ++result.revisits;
        nis += a.nis;
        dof += a.dof;
      }
      seen->second = step.step;
    }
  }
  result.mean_nis_per_dof = result.revisits == 0 ? nan : nis / dof;
  return result;
}

std::optional<ParticleEvaluation> evaluate_particles(const std::vector<core::StepReport>& steps) {
  ParticleEvaluation result;
  for (const core::StepReport& step : steps) {
    if (!step.particles) continue;
    const core::CloudReport& cloud = *step.particles;
    result.mean_effective_share += cloud.effective_size / static_cast<double>(cloud.hypotheses);
    result.resamplings += cloud.resampled ? 1 : 0;
    result.mean_ancestors += static_cast<double>(cloud.distinct_ancestors);
    result.least_ancestors =
        result.scans == 0 ? cloud.distinct_ancestors : std::min(result.least_ancestors, cloud.distinct_ancestors);
    ++result.scans;
  }
  if (result.scans == 0) return std::nullopt;
  result.mean_effective_share /= static_cast<double>(result.scans);
  result.mean_ancestors /= static_cast<double>(result.scans);
  return result;
}

}  // namespace

double quantile_of_sorted(const std::vector<double>& sorted, double fraction) {
  if (sorted.empty()) return nan;
  const double place = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  if (below + 1 == sorted.size()) return sorted.back();
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[below + 1] - sorted[below]);
}

ErrorStatistics error_statistics(std::vector<double> errors) {
  if (errors.empty()) return {0, nan, nan, nan, nan};
  std::sort(errors.begin(), errors.end());
  double squares = 0.0;
  for (const double error : errors) squares += error * error;
  return {errors.size(), std::sqrt(squares / static_cast<double>(errors.size())), quantile_of_sorted(errors, 0.5),
          quantile_of_sorted(errors, 0.95), errors.back()};
}

Evaluation evaluate(const runs::Run& run, const runs::RunTruth& truth, const EvaluationOptions& options) {
  Evaluation evaluation;
  evaluation.steps = run.steps.size();
  if (!truth.positions.empty()) evaluation.position = evaluate_positions(run.steps, truth, options.fix_limit_m);
  if (!truth.poses.empty()) {
    auto [position, pose] = evaluate_poses(run.steps, truth, runs::report_frames(run), options.nees_from_ns);
    pose.is_on_given_map = runs::only_localized(run);
    evaluation.pose = std::move(pose);
    if (!evaluation.position) evaluation.position = std::move(position);
  }
  if (evaluation.position && evaluation.position->against_poses) {
    evaluation.position->off_earlier_map = runs::began_off_earlier_map(run) && !runs::is_on_earlier_map(run);
  }
  evaluation.final_position = evaluate_final(run, truth, options.fix_limit_m);
  const core::Pose2 T_truth_map = evaluation.position ? evaluation.position->T_truth_map : core::Pose2{};
  if (!truth.landmarks.empty()) evaluation.map = evaluate_map(run, truth, T_truth_map, options.landmark_limit_m);
  evaluation.nis = evaluate_nis(run.steps);
  evaluation.revisits = evaluate_revisits(run.steps);
  evaluation.particles = evaluate_particles(run.steps);
  return evaluation;
}

}  // namespace helixnav::evaluation
