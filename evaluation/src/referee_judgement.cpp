// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/rigid_fit.hpp"
#include "helixnav/evaluation/nees.hpp"
#include "referee_book.hpp"

namespace helixnav::evaluation {
namespace {

using core::Label;
using core::MapLandmark;
using core::StepReport;

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double relative_reach_m = 80.0;  // old landmarks farther than this say nothing about here
constexpr std::size_t least_relative = 3;

/// Landmarks: their positions on the map and those of their trees.
struct Places {
  std::vector<Eigen::Vector2d> map_m;
  std::vector<Eigen::Vector2d> true_m;
};

/// Root mean square distance after the best rigid motion; NaN with fewer than two.
double rms_after_fit(const Places& places) {
  if (places.map_m.size() < 2) return no_number;
  const core::Pose2 T_true_map = core::fit_rigidly(places.true_m, places.map_m);
  double sum_m2 = 0.0;
  for (std::size_t i = 0; i < places.map_m.size(); ++i) {
    sum_m2 += (core::transform(T_true_map, places.map_m[i]) - places.true_m[i]).squaredNorm();
  }
  return std::sqrt(sum_m2 / static_cast<double>(places.map_m.size()));
}

double median(std::vector<double> values) {
  if (values.empty()) return no_number;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

PoseError error_between(const core::Pose2& estimate, const core::Pose2& truth) {
  return {(estimate.position_m() - truth.position_m()).norm(),
          std::abs(core::wrap_to_pi(estimate.heading_rad - truth.heading_rad))};
}

void Referee::Book::judge_closure(const StepReport& report, const std::vector<MapLandmark>& map) {
  ClosureScore closure;
  closure.step = report.step;
  if (!score.returns.empty() && !score.returns.back().closed) closure.after_reentry_m = driven_m - reentered_at_m;
  closure.pairs = static_cast<int>(report.merged.size());
  for (const core::MergedLandmarks& pair : report.merged) {
    identities.fix_if_unseen(pair.kept, driven_m - options.old_after_m);
    const Label kept = identities.identity(pair.kept);
    if (kept == core::no_label || kept != identities.identity(pair.removed)) ++closure.wrong_pairs;
  }
  for (const core::Decision& decision : report.decisions) {
    if (const auto* test = std::get_if<core::VerificationDecision>(&decision)) closure.rival_share = test->rival_share;
  }
  std::set<core::LandmarkId> kept;
  for (const core::MergedLandmarks& pair : report.merged) kept.insert(pair.kept);
  closure.pose = judge({pose, truth(), std::move(kept)}, map);
  // Without a return, before the first or at all, there may still be something to close: a town crossing is old ground
  // from two sides. Then the pairs' labels decide.
  const bool nothing_to_close = score.returns.empty() && closure.pairs == 0;
  closure.is_false =
      nothing_to_close || is_wrong(closure.pose.relative) || too_many_wrong(closure.wrong_pairs, closure.pairs);
  if (!score.returns.empty()) score.returns.back().closed = true;
  score.closures.push_back(closure);
}

JudgedPose Referee::Book::judge(const Judgeable& pose_at, const std::vector<MapLandmark>& map) const {
  return {error_between(pose_at.estimate.mean, pose_at.truth), relative_error(pose_at, map),
          nees(pose_at.estimate, pose_at.truth)};
}

/// Relative to the old landmarks that were recognised, if three of them are still on the map: others nearby may be on
/// another street of the map, to which no loop has been closed yet. Otherwise relative to the nearest.
PoseError Referee::Book::relative_error(const Judgeable& pose_at, const std::vector<MapLandmark>& map) const {
  const core::Pose2& estimate = pose_at.estimate.mean;
  const auto is_recognised = [&](const MapLandmark& landmark) { return pose_at.recognised.count(landmark.id) > 0; };
  const bool by_recognised =
      static_cast<std::size_t>(std::count_if(map.begin(), map.end(), is_recognised)) >= least_relative;
  std::vector<std::pair<double, std::pair<Eigen::Vector2d, Eigen::Vector2d>>> near;  // in the map, in truth
  for (const MapLandmark& landmark : map) {
    if (landmark.state != core::LandmarkState::mature || !identities.is_old(landmark.id)) continue;
    if (by_recognised && !is_recognised(landmark)) continue;
    const auto tree = static_cast<std::size_t>(identities.identity(landmark.id));
    const Eigen::Vector2d& map_m = landmark.point.mean_m;
    near.push_back({(map_m - estimate.position_m()).norm(), {map_m, recording.true_landmarks.at(tree).point_m}});
  }
  std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  if (near.size() < least_relative || near[least_relative - 1].first > relative_reach_m) {
    return error_between(estimate, pose_at.truth);
  }
  near.resize(std::min(near.size(), static_cast<std::size_t>(options.relative_landmarks)));
  Places places;
  for (const auto& [distance_m, place] : near) {
    places.map_m.push_back(place.first);
    places.true_m.push_back(place.second);
  }
  return error_between(core::compose(core::fit_rigidly(places.true_m, places.map_m), estimate), pose_at.truth);
}

double Referee::Book::spacing_m() const {
  const std::set<Label>& trees = seen_until_return.empty() ? seen : seen_until_return.front();
  std::vector<double> nearest_m;
  for (const Label a : trees) {
    double best_m = std::numeric_limits<double>::infinity();
    for (const Label b : trees) {
      if (a == b) continue;
      best_m = std::min(best_m, (recording.true_landmarks.at(static_cast<std::size_t>(a)).point_m -
                                 recording.true_landmarks.at(static_cast<std::size_t>(b)).point_m)
                                    .norm());
    }
    if (std::isfinite(best_m)) nearest_m.push_back(best_m);
  }
  return median(std::move(nearest_m));
}

void Referee::Book::score_map(const std::vector<MapLandmark>& map, RunScore& result) const {
  std::set<Label> placed;
  Places places;
  for (const MapLandmark& landmark : map) {
    if (landmark.state != core::LandmarkState::mature) continue;
    ++result.mature_landmarks;
    const Label tree = identities.identity(landmark.id);
    if (tree == core::no_label) {
      ++result.not_trees;
      continue;
    }
    if (!placed.insert(tree).second) ++result.duplicates;
    places.map_m.push_back(landmark.point.mean_m);
    places.true_m.push_back(recording.true_landmarks.at(static_cast<std::size_t>(tree)).point_m);
  }
  result.map_rms_m = rms_after_fit(places);
}

void Referee::Book::pass_verdict(RunScore& result) const {
  bool wrong = std::any_of(result.closures.begin(), result.closures.end(),
                           [](const ClosureScore& closure) { return closure.is_false; });
  if (returns_at_m.empty()) {
    result.closed_by_association = result.closures.empty() && result.wrong_old_matches >= options.association_matches;
    wrong = wrong || result.closed_by_association;
  }
  for (ReturnScore& one : result.returns) {
    if (one.closed || one.old_matches < options.association_matches) continue;
    one.closed = result.closed_by_association = true;
    wrong = wrong || is_wrong(one.associated.relative) || too_many_wrong(one.wrong_old_matches, one.old_matches);
  }
  const bool all_closed =
      !returns_at_m.empty() && result.returns.size() == returns_at_m.size() &&
      std::all_of(result.returns.begin(), result.returns.end(), [](const ReturnScore& one) { return one.closed; });
  result.verdict = wrong ? RunVerdict::false_closure : all_closed ? RunVerdict::closed : RunVerdict::undecided;
  result.diverged_after_closure =
      result.verdict == RunVerdict::closed && result.end_on_old_ground.relative.position_m > options.wrong_position_m;
}

}  // namespace helixnav::evaluation
