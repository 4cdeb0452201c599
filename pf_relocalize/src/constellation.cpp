// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/constellation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tile_sum.hpp"

namespace helixnav::pf_relocalize {
namespace {

constexpr int unmatched = -1;

struct Candidate {
  int branch;
  int old_landmark;
  double distance_m;
  double tolerance_m;
};

/// Branch landmarks with enough hits, placed in the map.
struct PlacedBranch {
  std::vector<const BranchLandmark*> landmarks;
  std::vector<Eigen::Vector2d> points_m;
};

PlacedBranch place(const Constellation& constellation, const core::Pose2& T_map_robot, int least_hits) {
  PlacedBranch placed;
  for (const BranchLandmark& landmark : constellation.branch) {
    if (landmark.hits < least_hits) continue;
    placed.landmarks.push_back(&landmark);
    placed.points_m.push_back(core::transform(T_map_robot, landmark.point_robot_m));
  }
  return placed;
}

/// Pairs within tolerance, nearest first.
std::vector<Candidate> candidates(const Constellation& constellation, const PlacedBranch& placed,
                                  const ConstellationLimits& limits) {
  std::vector<Candidate> pairs;
  for (std::size_t i = 0; i < placed.points_m.size(); ++i) {
    const double lever_m = limits.lever_rad * placed.landmarks[i]->point_robot_m.norm();
    for (std::size_t j = 0; j < constellation.old_landmarks.size(); ++j) {
      const core::PointGaussian& old = constellation.old_landmarks[j].point;
      const double distance = (placed.points_m[i] - old.mean_m).norm();
      if (distance >= limits.most_tolerance_m) continue;
      const double variance = largest_variance(old.covariance_m2) + limits.branch_sigma_m * limits.branch_sigma_m;
      const double tolerance_m = 3.0 * std::sqrt(variance) + lever_m;
      if (distance < tolerance_m && constellation.population.look_alike(constellation.old_landmarks[j].appearance,
                                                                        placed.landmarks[i]->appearance))
        pairs.push_back({static_cast<int>(i), static_cast<int>(j), distance, tolerance_m});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Candidate& a, const Candidate& b) { return a.distance_m < b.distance_m; });
  return pairs;
}

/// One-to-one matching: greedy, then augmenting paths until it is a largest one.
class Matching {
 public:
  Matching(std::size_t branch, std::size_t old_landmarks, const std::vector<Candidate>& pairs)
      : edges_(branch), old_of_(branch, unmatched), branch_of_(old_landmarks, unmatched) {
    for (const Candidate& pair : pairs) {
      edges_[index(pair.branch)].push_back(pair.old_landmark);
      if (old_of_[index(pair.branch)] == unmatched && branch_of_[index(pair.old_landmark)] == unmatched) {
        join(pair.branch, pair.old_landmark);
      }
    }
    for (std::size_t i = 0; i < branch; ++i) {
      if (old_of_[i] != unmatched) continue;
      visited_.assign(old_landmarks, false);
      augment(static_cast<int>(i));
    }
  }

  int old_of(std::size_t branch) const { return old_of_[branch]; }
  bool old_is_free(std::size_t old_landmark) const { return branch_of_[old_landmark] == unmatched; }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  void join(int branch, int old_landmark) {
    old_of_[index(branch)] = old_landmark;
    branch_of_[index(old_landmark)] = branch;
  }

  /// Finds a partner for `branch`, moving others to their alternatives; false when there is none.
  bool augment(int branch) {
    for (const int old_landmark : edges_[index(branch)]) {
      if (visited_[index(old_landmark)]) continue;
      visited_[index(old_landmark)] = true;
      const int holder = branch_of_[index(old_landmark)];
      if (holder != unmatched && !augment(holder)) continue;
      join(branch, old_landmark);
      return true;
    }
    return false;
  }

  std::vector<std::vector<int>> edges_;  // old landmarks of each branch landmark, nearest first
  std::vector<int> old_of_, branch_of_;
  std::vector<bool> visited_;
};

/// Median distance of an old landmark from its nearest neighbour.
double spacing_m(const std::vector<OldLandmark>& landmarks) {
  std::vector<double> nearest_m;
  for (const OldLandmark& one : landmarks) {
    double least2 = std::numeric_limits<double>::infinity();
    for (const OldLandmark& other : landmarks) {
      if (&other != &one) least2 = std::min(least2, (other.point.mean_m - one.point.mean_m).squaredNorm());
    }
    nearest_m.push_back(std::sqrt(least2));
  }
  const auto middle = nearest_m.begin() + static_cast<std::ptrdiff_t>(nearest_m.size() / 2);
  std::nth_element(nearest_m.begin(), middle, nearest_m.end());
  return *middle;
}

/// ConstellationScore::appearance_matches of the pairs that were matched.
double appearance_matches(const Constellation& constellation, const PlacedBranch& placed, const Matching& matching,
                          const std::vector<Candidate>& candidates) {
  constexpr double least_nats = 3.0;  // where landmarks are so dense that one in twenty has a partner by chance
  double nearest_m = -1.0;
  double worth = 0.0;
  for (const Candidate& pair : candidates) {
    const auto i = static_cast<std::size_t>(pair.branch);
    if (matching.old_of(i) != pair.old_landmark) continue;
    const OldLandmark& old = constellation.old_landmarks[static_cast<std::size_t>(pair.old_landmark)];
    const double nats = constellation.population.compare(old.appearance, placed.landmarks[i]->appearance).nats;
    if (nats == 0.0) continue;
    if (nearest_m < 0.0) nearest_m = spacing_m(constellation.old_landmarks);
    const double by_chance = -std::expm1(-std::log(2.0) * std::pow(pair.tolerance_m / nearest_m, 2));
    worth += nats / std::max(least_nats, -std::log(by_chance));
  }
  return worth;
}

bool counts(const ConstellationScore& rival, const ConstellationScore& winner, const ConstellationLimits& limits) {
  return rival.matched >= limits.rival_least_matches && rival.matched >= limits.rival_match_share * winner.matched;
}

/// Then the particle filter, which only looks at places, may well be where no pair looks alike.
bool tells_appearance(const Constellation& constellation) {
  return std::any_of(constellation.branch.begin(), constellation.branch.end(),
                     [](const BranchLandmark& one) { return one.appearance.is_given(); });
}

/// Had it one: a winner of none has no ratio that a rival's could be compared with.
double ratio_of_one_match(const ConstellationScore& score) {
  return 1.0 / (1.0 + 0.5 * (score.unmatched_branch + score.unmatched_old));
}

ConstellationReason reason_for(const ConstellationVerdict& verdict, const ConstellationLimits& limits) {
  const bool enough = verdict.winner.matched + verdict.winner.appearance_matches >= limits.least_matches &&
                      verdict.winner.matched >= std::min(limits.least_matches, limits.rival_least_matches);
  if (!enough) return ConstellationReason::too_few_matches;
  if (verdict.winner.ratio <= limits.least_ratio) return ConstellationReason::ratio_too_low;
  return verdict.rival_share >= limits.rival_ratio ? ConstellationReason::rival_too_good
                                                   : ConstellationReason::accepted;
}

}  // namespace

bool Coverage::covers(const Eigen::Vector2d& point_m) const {
  core::FieldOfView shrunk = field_of_view;
  shrunk.max_range_m *= range_share;
  const bool all_around = shrunk.max_bearing_rad - shrunk.min_bearing_rad >= 2.0 * core::pi - 1e-9;
  if (!all_around) {
    shrunk.min_bearing_rad += bearing_margin_rad;
    shrunk.max_bearing_rad -= bearing_margin_rad;
  }
  const double middle = 0.5 * (shrunk.min_bearing_rad + shrunk.max_bearing_rad);
  const double half = 0.5 * (shrunk.max_bearing_rad - shrunk.min_bearing_rad);
  int views = 0;
  for (const core::Pose2& pose : T_frame_sensor) {
    const Eigen::Vector2d d = point_m - pose.position_m();
    const double range = d.norm();
    if (range < shrunk.min_range_m || range > shrunk.max_range_m) continue;
    const double bearing = std::atan2(d.y(), d.x()) - pose.heading_rad;
    if (!all_around && std::abs(core::wrap_to_pi(bearing - middle)) > half) continue;
    if (++views >= least_views) return true;
  }
  return false;
}

ConstellationScore score_constellation(const Constellation& constellation, const core::Pose2& T_map_robot,
                                       const ConstellationLimits& limits) {
  const PlacedBranch placed = place(constellation, T_map_robot, limits.least_hits);
  const std::vector<Candidate> near = candidates(constellation, placed, limits);
  const Matching matching(placed.points_m.size(), constellation.old_landmarks.size(), near);
  ConstellationScore score;
  score.T_map_robot = T_map_robot;
  for (std::size_t i = 0; i < placed.points_m.size(); ++i) {
    const int j = matching.old_of(i);
    if (j == unmatched) {
      score.unmatched_branch += constellation.old_drive.covers(placed.points_m[i]) ? 1 : 0;
      continue;
    }
    const OldLandmark& old = constellation.old_landmarks[static_cast<std::size_t>(j)];
    score.pairs.push_back({placed.landmarks[i]->id, old.id, (placed.points_m[i] - old.point.mean_m).norm()});
  }
  score.matched = static_cast<int>(score.pairs.size());
  score.appearance_matches = appearance_matches(constellation, placed, matching, near);
  const core::Pose2 T_robot_map = core::inverse(T_map_robot);
  for (std::size_t j = 0; j < constellation.old_landmarks.size(); ++j) {
    const Eigen::Vector2d seen_from_now = core::transform(T_robot_map, constellation.old_landmarks[j].point.mean_m);
    if (matching.old_is_free(j) && constellation.new_drive.covers(seen_from_now)) ++score.unmatched_old;
  }
  const double against = 0.5 * (score.unmatched_branch + score.unmatched_old);
  score.ratio = score.matched == 0 ? 0.0 : score.matched / (score.matched + against);
  return score;
}

ConstellationVerdict judge_constellation(const Constellation& constellation, const core::Pose2& winner,
                                         const std::vector<core::Pose2>& rivals, const ConstellationLimits& limits) {
  ConstellationVerdict verdict;
  verdict.winner = score_constellation(constellation, winner, limits);
  verdict.rivals_tried = static_cast<int>(rivals.size());
  for (const core::Pose2& pose : rivals) {
    ConstellationScore rival = score_constellation(constellation, pose, limits);
    if (!counts(rival, verdict.winner, limits)) continue;
    if (rival.ratio > verdict.rival.ratio) verdict.rival = rival;
    if (rival.ratio >= limits.rival_ratio * verdict.winner.ratio) verdict.contesting.push_back(std::move(rival));
  }
  verdict.rival_share = verdict.winner.ratio > 0.0 ? verdict.rival.ratio / verdict.winner.ratio : 0.0;
  if (verdict.winner.matched == 0 && tells_appearance(constellation)) {
    verdict.rival_share = verdict.rival.ratio / ratio_of_one_match(verdict.winner);
  }
  verdict.reason = reason_for(verdict, limits);
  verdict.accepted = verdict.reason == ConstellationReason::accepted;
  if (verdict.reason != ConstellationReason::rival_too_good) verdict.contesting.clear();
  return verdict;
}

}  // namespace helixnav::pf_relocalize
