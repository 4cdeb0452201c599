// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/se2.hpp"
#include "question/prepared.hpp"

namespace helixnav::relocalize {

/// A point of the question and a landmark of the map taken to be the same.
struct Match {
  std::size_t point = 0;
  Slot slot = no_slot;
  bool operator==(const Match& other) const { return point == other.point && slot == other.slot; }
};

/// A pose with its evidence.
struct Hypothesis {
  core::Pose2 T_origin_centre;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< on T_origin_centre
  std::vector<Match> matches;
  double chi2 = 0.0;
  double evidence = 0.0;
  int unmatched = 0;
  int missed = 0;
};

/// Difference (map − question) of a pair at a pose, and its covariance: that of the map's landmark and the turned one of
/// the question's.
struct Difference {
  Eigen::Vector2d value_m;
  Eigen::Matrix2d covariance_m2;
};
Difference difference(const Prepared& asked, const core::Pose2& T_origin_centre, const Match& match);

/// One weighted Gauss–Newton step on fixed pairs; `blur_m2` is added to each covariance. The information is left as of the
/// pose before the step. False, and no step, when the pairs do not fix a pose.
bool step_pose(const Prepared& asked, const std::vector<Match>& matches, double blur_m2, core::Pose2& T_origin_centre,
               Eigen::Matrix3d& information);

/// Draws the pose to the landmarks near its points, for each of `shares` once: points pair with the nearest landmark within
/// that share of `near_m`, or for a share of 0 with the likeliest within 3.5 σ.
void refine(const Prepared& asked, const std::vector<double>& shares, core::Pose2& T_origin_centre);

/// Pairs one to one, the likeliest first, settles the pose on them, and weighs: docs/relocalize.md §3. Evidence is −∞ for
/// fewer than three pairs.
Hypothesis weigh(const Prepared& asked, const core::Pose2& T_origin_centre);

}  // namespace helixnav::relocalize
