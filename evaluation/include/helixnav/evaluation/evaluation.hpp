// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/se2.hpp"
#include "helixnav/core/time.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::evaluation {

/// Statistics of a list of non-negative errors; quantiles interpolate between order statistics. NaN when count is 0.
struct ErrorStatistics {
  std::size_t count = 0;
  double rmse = 0.0;
  double median = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};
ErrorStatistics error_statistics(std::vector<double> errors);

/// The `fraction` quantile of an ascending list, linear between order statistics; NaN for an empty list.
double quantile_of_sorted(const std::vector<double>& sorted, double fraction);

/// Estimate against truth at one instant, in the map frame; in the part's own frame for a part of the drive that was
/// never placed.
struct PositionError {
  core::Nanoseconds t_ns = 0;
  Eigen::Vector2d true_map_m = Eigen::Vector2d::Zero();  ///< the fix, brought into the map frame
  Eigen::Vector2d error_m = Eigen::Vector2d::Zero();     ///< estimate − truth, along x and y of the map
  Eigen::Vector2d sigma_m = Eigen::Vector2d::Zero();     ///< of the estimate, as reported by the filter
  bool used = true;
};

/// Position of the reference point (against true poses) or of the antenna (against true positions).
struct PositionEvaluation {
  bool aligned = false;  ///< a rigid alignment was applied between the frames; false: the truth is in the map frame
  bool against_poses = false;
  bool off_earlier_map =
      false;                ///< its place there was sought and not found: the errors are of the path since its begin
  core::Pose2 T_truth_map;  ///< identity when not aligned
  double limit_m = 0.0;     ///< fixes with larger errors are left out; infinite against true poses
  ErrorStatistics error_m;  ///< over the fixes used
  double rmse_aligned_m =
      0.0;  ///< against poses: what a rigid alignment leaves of it, whether it stands between or not
  std::size_t fixes_used = 0;
  std::size_t fixes_left_out = 0;  ///< farther away than limit_m after the alignment
  std::size_t fixes_outside = 0;   ///< before the first or after the last step: nothing to compare with
  std::size_t fixes_in_gaps = 0;   ///< between steps farther apart than `gap_s`: the path there is a guess
  double gap_s = 0.0;              ///< three times the 90 % quantile of the run's step intervals
  std::size_t steps_moved = 0;  ///< reported elsewhere at the time, and judged where they are known to have been since
  double moved_m = 0.0;         ///< the farthest of them
  std::vector<PositionError> errors;
};

struct HeadingError {
  core::Nanoseconds t_ns = 0;
  double error_rad = 0.0;  ///< estimate − truth, wrapped
  double sigma_rad = 0.0;
  double nees = 0.0;  ///< eᵀP⁻¹e of (x, y, heading); NaN if P is singular, or there is nothing to compare with
};

/// Only against true poses.
struct PoseEvaluation {
  ErrorStatistics heading_error_rad;
  std::size_t nees_count = 0;
  std::size_t nees_in_own_frame =
      0;                          ///< of these: against the truth since the session or part began, before it was placed
  std::size_t nees_left_out = 0;  ///< no truth at that start, or reported in a frame later known to be wrong
  /// The pose was estimated in a given map: its covariance describes the place on that map and leaves out the map's own
  /// errors, which are in the error.
  bool is_on_given_map = false;
  double nees_mean = 0.0;       ///< 3 when the filter is consistent, unless it is on a given map
  double nees_inside_95 = 0.0;  ///< fraction within the two-sided 95 % band of χ²₃
  std::vector<HeadingError> errors;
};

/// Mature landmarks against true landmarks, one to one.
struct MapEvaluation {
  bool by_label = false;       ///< paired by the labels of their observations; else by distance
  double limit_m = 0.0;        ///< for pairing by distance, unless the map itself reports a larger uncertainty
  ErrorStatistics error_m;     ///< over the pairs
  std::size_t missing = 0;     ///< true landmarks without a partner; by label: only those in ≥ 10 observations
  std::size_t duplicates = 0;  ///< further landmarks on a true landmark that already has a partner
  std::size_t spurious = 0;    ///< landmarks that match no true landmark
};

/// Innovations of the joint updates against χ² with their degrees of freedom.
struct NisEvaluation {
  std::size_t updates = 0;
  double mean_per_dof = 0.0;  ///< 1 when the filter is consistent; NaN without updates
  double mean_low_95 = 0.0;   ///< two-sided 95 % band of that mean, as if the updates were independent
  double mean_high_95 = 0.0;
  double inside_95 = 0.0;  ///< fraction within the two-sided 95 % band
};

/// First matches of landmarks that had not been seen for `unseen_steps` steps: how well the map predicts after a
/// detour, before it is corrected. Needs no truth, and shows systematic errors of odometry and sensor first.
struct RevisitEvaluation {
  static constexpr std::int64_t unseen_steps = 150;
  std::size_t revisits = 0;
  double mean_nis_per_dof = 0.0;  ///< NaN without revisits
};

/// For a particle-cloud estimator: whether its covariance can be trusted. The mean effective size is no cause for
/// alarm; few ancestors are (core::CloudReport).
struct ParticleEvaluation {
  std::size_t scans = 0;
  double mean_effective_share = 0.0;  ///< effective size divided by the number of hypotheses weighed
  std::size_t resamplings = 0;
  double mean_ancestors = 0.0;
  std::size_t least_ancestors = 0;
};

struct Evaluation {
  std::size_t steps = 0;
  std::optional<PositionEvaluation> position;
  std::optional<PositionEvaluation> final_position;  ///< of the path as known at the end, if it was corrected
  std::optional<PoseEvaluation> pose;
  std::optional<MapEvaluation> map;
  NisEvaluation nis;
  RevisitEvaluation revisits;
  std::optional<ParticleEvaluation> particles;
};

struct EvaluationOptions {
  double fix_limit_m = 10.0;
  double landmark_limit_m = 2.0;  ///< or four of a landmark's standard deviations, up to half-way to the next true one
  /// NEES is counted from here on, e.g. for a robot that joined the common frame of its team then: its earlier
  /// covariances referred to another frame.
  core::Nanoseconds nees_from_ns = std::numeric_limits<core::Nanoseconds>::min();
};

/// Compares a run with `truth`. The estimate is interpolated at the instants of the truth along arcs of constant twist;
/// instants in gaps between scans (PositionEvaluation::gap_s) are ignored, for positions and headings as well as for
/// NEES. True positions: the antenna's estimated position (pose ∘ lever arm), rigid alignment with outliers left out.
/// True poses: no alignment if they are in the map frame (runs::RunTruth::frame), else a rigid one of all of them; NEES
/// at the same instants with the covariance of the step before. Steps reported in a frame of their own, before a
/// session or part was placed, have a covariance relative to the start of that frame: NEES compares it with the truth
/// since then. For a part that was never placed, the errors are relative to that start, too. Landmarks: after the same
/// alignment. Test: evaluation/evaluation_test.cpp (hand-computed values).
Evaluation evaluate(const runs::Run& run, const runs::RunTruth& truth, const EvaluationOptions& options = {});
inline Evaluation evaluate(const runs::Run& run, const EvaluationOptions& options = {}) {
  return evaluate(run, run.truth, options);
}

}  // namespace helixnav::evaluation
