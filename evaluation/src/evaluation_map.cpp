// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

namespace helixnav::evaluation {

namespace {

struct MovedLandmark {
  core::LandmarkId id;
  int observations;
  Eigen::Vector2d point_truth_m;
  double sigma_m;  ///< along the longer axis of its ellipse
};

std::vector<MovedLandmark> mature_landmarks(const runs::Run& run, const core::Pose2& T_truth_map) {
  std::vector<MovedLandmark> landmarks;
  for (const core::MapLandmark& landmark : run.map) {
    if (landmark.state != core::LandmarkState::mature) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(landmark.point.covariance_m2, Eigen::EigenvaluesOnly);
    landmarks.push_back({landmark.id, landmark.observations, core::transform(T_truth_map, landmark.point.mean_m),
                         std::sqrt(std::max(axes.eigenvalues().maxCoeff(), 0.0))});
  }
  return landmarks;
}

// How often each label was seen, in all and in the observations used for each landmark: one that only may be a landmark
// says nothing of which tree that landmark is.
struct LabelCounts {
  std::map<core::Label, int> in_all;
  std::map<core::LandmarkId, std::map<core::Label, int>> by_landmark;
};

LabelCounts count_labels(const runs::Run& run, const runs::RunTruth& truth) {
  LabelCounts counts;
  for (const core::StepReport& step : run.steps) {
    const auto index = static_cast<std::size_t>(step.step);
    if (index >= truth.labels.size()) continue;
    for (const core::AssociationReport& a : step.associations) {
      const auto k = static_cast<std::size_t>(a.observation);
      const core::Label label = k < truth.labels[index].size() ? truth.labels[index][k] : core::no_label;
      if (label != core::no_label) ++counts.in_all[label];
      const bool is_used = a.outcome == core::Outcome::matched || a.outcome == core::Outcome::augmented;
      if (is_used) ++counts.by_landmark[a.landmark][label];
    }
  }
  return counts;
}

core::Label most_frequent(const std::map<core::Label, int>& counts) {
  const auto most =
      std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? core::no_label : most->first;
}

/// Whether an observation of the run carries the label of a true landmark.
bool can_be_paired(const LabelCounts& counts, const runs::RunTruth& truth) {
  return std::any_of(truth.landmarks.begin(), truth.landmarks.end(),
                     [&](const core::TrueLandmark& known) { return counts.in_all.count(known.label) > 0; });
}

struct NearPair {
  double distance_m;
  std::size_t landmark;
  std::size_t known;

  bool operator<(const NearPair& other) const {
    return std::tie(distance_m, landmark, known) < std::tie(other.distance_m, other.landmark, other.known);
  }
};

/// [true landmark] half the distance to the next one; infinite if it is alone. `by_x`: their x, ascending, and the
/// index.
std::vector<double> half_ways_m(const std::vector<core::TrueLandmark>& known,
                                const std::vector<std::pair<double, std::size_t>>& by_x) {
  std::vector<double> half_m(known.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < by_x.size(); ++i) {
    double& least_m = half_m[by_x[i].second];
    const auto may_be_nearer = [&](std::size_t j) {
      if (std::abs(by_x[j].first - by_x[i].first) >= 2.0 * least_m) return false;
      const auto apart_m = known[by_x[i].second].point_m - known[by_x[j].second].point_m;
      least_m = std::min(least_m, 0.5 * apart_m.norm());
      return true;
    };
    for (std::size_t j = i + 1; j < by_x.size() && may_be_nearer(j); ++j) {
    }
    for (std::size_t j = i; j > 0 && may_be_nearer(j - 1); --j) {
    }
  }
  return half_m;
}

/// Landmarks and true landmarks no farther apart than the limit, or than four standard deviations of the landmark if
/// that is less than half-way to the next true one; nearest first. Each landmark is only compared with true ones whose
/// x is as near.
std::vector<NearPair> near_pairs(const runs::RunTruth& truth, const std::vector<MovedLandmark>& landmarks,
                                 double limit_m) {
  std::vector<std::pair<double, std::size_t>> by_x;
  for (std::size_t j = 0; j < truth.landmarks.size(); ++j) by_x.emplace_back(truth.landmarks[j].point_m.x(), j);
  std::sort(by_x.begin(), by_x.end());
  const std::vector<double> half_m = half_ways_m(truth.landmarks, by_x);
  std::vector<NearPair> pairs;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    const Eigen::Vector2d& point_m = landmarks[i].point_truth_m;
    constexpr double sigmas = 4.0;
    const double most_m = std::max(limit_m, sigmas * landmarks[i].sigma_m);
    auto next = std::lower_bound(by_x.begin(), by_x.end(), std::make_pair(point_m.x() - most_m, std::size_t{0}));
    for (; next != by_x.end() && next->first <= point_m.x() + most_m; ++next) {
      const double distance_m = (point_m - truth.landmarks[next->second].point_m).norm();
      if (distance_m <= std::max(limit_m, std::min(most_m, half_m[next->second])))
        pairs.push_back({distance_m, i, next->second});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Among landmarks that this run never saw (from an earlier map, or other robots), those that are on no true landmark.
std::size_t count_off_truth(const runs::RunTruth& truth, const std::vector<MovedLandmark>& unseen, double limit_m) {
  std::set<std::size_t> on_truth;
  for (const NearPair& pair : near_pairs(truth, unseen, limit_m)) on_truth.insert(pair.landmark);
  return unseen.size() - on_truth.size();
}

MapEvaluation evaluate_by_label(LabelCounts counts, const runs::RunTruth& truth,
                                const std::vector<MovedLandmark>& landmarks, double limit_m) {
  constexpr int seen_often = 10;
  MapEvaluation result;
  result.by_label = true;
  std::map<core::Label, std::vector<const MovedLandmark*>> of_label;
  std::vector<MovedLandmark> unseen;
  for (const MovedLandmark& landmark : landmarks) {
    if (counts.by_landmark.count(landmark.id) == 0) {
      unseen.push_back(landmark);
      continue;
    }
    of_label[most_frequent(counts.by_landmark[landmark.id])].push_back(&landmark);
  }
  std::vector<double> errors_m;
  std::size_t claimed = 0;
  for (const core::TrueLandmark& known : truth.landmarks) {
    const auto found = of_label.find(known.label);
    if (found == of_label.end()) {
      result.missing += counts.in_all[known.label] >= seen_often ? 1 : 0;
      continue;
    }
    const auto& rivals = found->second;
    const MovedLandmark* partner = *std::max_element(
        rivals.begin(), rivals.end(), [](const auto* a, const auto* b) { return a->observations < b->observations; });
    errors_m.push_back((partner->point_truth_m - known.point_m).norm());
    result.duplicates += rivals.size() - 1;
    claimed += rivals.size();
  }
  result.spurious = landmarks.size() - unseen.size() - claimed + count_off_truth(truth, unseen, limit_m);
  result.error_m = error_statistics(std::move(errors_m));
  return result;
}

MapEvaluation evaluate_by_distance(const runs::RunTruth& truth, const std::vector<MovedLandmark>& landmarks,
                                   double limit_m) {
  MapEvaluation result;
  result.limit_m = limit_m;
  const std::vector<NearPair> pairs = near_pairs(truth, landmarks, limit_m);
  std::vector<bool> near_truth(landmarks.size(), false);
  for (const NearPair& pair : pairs) near_truth[pair.landmark] = true;
  std::vector<bool> landmark_taken(landmarks.size(), false);
  std::vector<bool> truth_taken(truth.landmarks.size(), false);
  std::vector<double> errors_m;
  for (const auto& [distance_m, i, j] : pairs) {
    if (landmark_taken[i] || truth_taken[j]) continue;
    landmark_taken[i] = truth_taken[j] = true;
    errors_m.push_back(distance_m);
  }
  result.missing = truth.landmarks.size() - errors_m.size();
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    result.duplicates += near_truth[i] && !landmark_taken[i] ? 1 : 0;
    result.spurious += near_truth[i] ? 0 : 1;
  }
  result.error_m = error_statistics(std::move(errors_m));
  return result;
}

}  // namespace

MapEvaluation evaluate_map(const runs::Run& run, const runs::RunTruth& truth, const core::Pose2& T_truth_map,
                           double limit_m) {
  const std::vector<MovedLandmark> landmarks = mature_landmarks(run, T_truth_map);
  LabelCounts counts = count_labels(run, truth);
  return can_be_paired(counts, truth) ? evaluate_by_label(std::move(counts), truth, landmarks, limit_m)
                                      : evaluate_by_distance(truth, landmarks, limit_m);
}

}  // namespace helixnav::evaluation
