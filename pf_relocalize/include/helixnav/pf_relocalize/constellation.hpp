// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/map_appearance.hpp"

namespace helixnav::pf_relocalize {

/// A landmark mapped since the trigger, in the frame of the vehicle where it is now.
struct BranchLandmark {
  core::LandmarkId id = core::no_landmark;
  Eigen::Vector2d point_robot_m = Eigen::Vector2d::Zero();
  int hits = 0;  ///< scans that saw it
  core::LandmarkAppearance appearance = {};
};

/// A landmark of the old map, in the frame that pose hypotheses are given in.
struct OldLandmark {
  core::LandmarkId id = core::no_landmark;
  core::PointGaussian point;
  core::LandmarkAppearance appearance = {};
};

/// Ground that a drive has looked at: sensor poses on it and what the sensor sees from each, shrunk by margins, because
/// at the edge of the view a landmark may well be missed.
struct Coverage {
  std::vector<core::Pose2> T_frame_sensor;
  core::FieldOfView field_of_view;
  double range_share = 0.85;        ///< of max_range_m
  double bearing_margin_rad = 0.1;  ///< off both sides, unless the view is all around
  int least_views = 1;

  /// True when `point_m` is in the shrunk view of at least least_views poses. Cost: linear in poses.
  bool covers(const Eigen::Vector2d& point_m) const;
};

/// Everything that the test compares. Values only: no filter, no map.
struct Constellation {
  std::vector<BranchLandmark> branch;          ///< all that were seen lately, whatever their hits
  std::vector<OldLandmark> old_landmarks;      ///< map frame
  Coverage old_drive;                          ///< map frame
  Coverage new_drive;                          ///< frame of the vehicle now; usually least_views = 2
  core::AppearancePopulation population = {};  ///< that classes and sizes come from; what these contradict is no pair
};

struct ConstellationLimits {
  int least_hits = 3;            ///< a branch landmark seen less often is left out
  double branch_sigma_m = 0.15;  ///< of a branch landmark relative to the vehicle
  double lever_rad = 0.012;      ///< tolerance per metre of distance from the vehicle
  double most_tolerance_m = 1.5;
  int least_matches = 5;  ///< less what class and size of the pairs are worth, but no fewer than rival_least_matches
  double least_ratio = 0.4;
  int rival_least_matches = 3;
  double rival_match_share = 0.4;  ///< a rival counts from max(rival_least_matches, share × M of the winner) on
  double rival_ratio = 0.75;       ///< refuse when a rival that counts reaches this share of the winner's ratio
};

/// One branch landmark that coincides with an old one.
struct ConstellationPair {
  core::LandmarkId branch = core::no_landmark;
  core::LandmarkId old_landmark = core::no_landmark;
  double distance_m = 0.0;
};

/// The evidence at one pose, every landmark counted once.
struct ConstellationScore {
  core::Pose2 T_map_robot;
  int matched = 0;           ///< M: largest one-to-one matching within min(3σ + lever·r, most_tolerance)
  int unmatched_branch = 0;  ///< u1: branch landmarks without a partner on ground that the old drive covered
  int unmatched_old = 0;     ///< u2: old landmarks without a partner on ground that the new drive covered
  double ratio = 0.0;        ///< M / (M + (u1 + u2)/2), 0 when M is 0; ground not covered by both is neutral
  std::vector<ConstellationPair> pairs;
  /// What class and size of the pairs say, in pairs: Σ nats / g, g = −ln of the probability that chance puts an old landmark
  /// within a pair's tolerance. M pairs that fix a pose of three numbers are worth (M − 3/2)·g nats, so with class and
  /// size fewer pairs carry as much evidence. 0 where nothing is given.
  double appearance_matches = 0.0;
};

/// Scores one pose hypothesis. Cost O(branch × old + (branch + old) × coverage poses); the matching is greedy by distance,
/// then augmented to the largest one. Source: PROTOTYPE §4. Test: pf_relocalize/constellation_test.cpp (brute force).
ConstellationScore score_constellation(const Constellation& constellation, const core::Pose2& T_map_robot,
                                       const ConstellationLimits& limits = {});

/// Why the test went as it did; the first that applies.
enum class ConstellationReason { accepted, too_few_matches, ratio_too_low, rival_too_good };

struct ConstellationVerdict {
  bool accepted = false;
  ConstellationReason reason = ConstellationReason::too_few_matches;
  ConstellationScore winner;
  ConstellationScore rival;  ///< best ratio among those that count; matched = 0 when none does
  std::vector<ConstellationScore>
      contesting;  ///< rivals that count and reach rival_ratio, if that is all that the winner failed for
  int rivals_tried = 0;
  /// rival.ratio / winner.ratio, to be kept below limits.rival_ratio. 0 for a winner without a pair; where classes or
  /// sizes are given, as if it had one pair.
  double rival_share = 0.0;
};

/// Winner against rivals. A rival is beaten only by contradictions on ground that both maps cover, never by lack of
/// coverage. The caller has to account for the cost of repeated looks. Test: pf_relocalize/constellation_test.cpp (a
/// shifted lattice is refused, a lattice whose end is in view accepted).
ConstellationVerdict judge_constellation(const Constellation& constellation, const core::Pose2& winner,
                                         const std::vector<core::Pose2>& rivals,
                                         const ConstellationLimits& limits = {});

}  // namespace helixnav::pf_relocalize
