// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/evaluation/association_score.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "helixnav/core/merged_ids.hpp"

namespace helixnav::evaluation {
namespace {

using core::Label;
using core::LandmarkId;
using Visit = std::pair<Label, int>;

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 1.0 : static_cast<double>(part) / static_cast<double>(whole);
}

std::size_t pairs_among(std::size_t n) { return n * (n - 1) / 2; }

template <class Key>
std::size_t pairs_in(const std::map<Key, std::size_t>& counts) {
  std::size_t pairs = 0;
  for (const auto& [key, n] : counts) pairs += pairs_among(n);
  return pairs;
}

class Scorer {
 public:
  explicit Scorer(const std::vector<core::StepReport>& steps) : merged_(steps) {}

  void add(const core::StepReport& step, const core::AssociationReport& association, Label label) {
    const bool matched = association.outcome == core::Outcome::matched;
    if (label == core::no_label) {
      score_.spurious += matched;
      return;
    }
    const Visit visit = visit_of(label, step.step);
    ++score_.labelled;
    ++of_label_[label];
    ++of_visit_[visit];
    if (matched || association.outcome == core::Outcome::augmented) attribute(association.landmark, label, visit);
    judge(association, label, matched);
  }

  AssociationScore finish(const std::vector<core::MapLandmark>& map) {
    for (const auto& [landmark, visits] : by_landmark_) {
      std::map<Label, std::size_t> by_label;
      std::size_t all = 0;
      for (const auto& [visit, n] : visits) {
        by_label[visit.first] += n;
        all += n;
      }
      score_.pairs_on_one_landmark += pairs_among(all);
      score_.pairs_right += pairs_in(by_label);
      score_.pairs_right_in_visit += pairs_in(visits);
    }
    score_.pairs_of_label = pairs_in(of_label_);
    score_.pairs_of_visit = pairs_in(of_visit_);
    count_map(map);
    return score_;
  }

 private:
  Visit visit_of(Label label, std::int64_t scan) {
    const auto [seen, first] = last_seen_.try_emplace(label, scan, 0);
    if (!first && scan - seen->second.first > AssociationScore::visit_gap_scans) ++seen->second.second;
    seen->second.first = scan;
    return {label, seen->second.second};
  }

  void attribute(LandmarkId landmark, Label label, const Visit& visit) {
    ++by_landmark_[merged_.now(landmark)][visit];
    identity_.try_emplace(landmark, label);
  }

  void judge(const core::AssociationReport& association, Label label, bool matched) {
    if (matched) {
      ++(identity_.at(association.landmark) == label ? score_.right : score_.wrong);
    } else if (begun_[label]) {
      ++score_.missed;
    }
    if (association.outcome == core::Outcome::augmented) begun_[label] = true;
  }

  void count_map(const std::vector<core::MapLandmark>& map) {
    std::map<Label, std::size_t> landmarks_of_label;
    for (const core::MapLandmark& landmark : map) {
      const auto visits = by_landmark_.find(merged_.now(landmark.id));
      if (landmark.state != core::LandmarkState::mature || visits == by_landmark_.end()) continue;
      std::map<Label, std::size_t> by_label;
      for (const auto& [visit, n] : visits->second) by_label[visit.first] += n;
      const auto most = std::max_element(by_label.begin(), by_label.end(),
                                         [](const auto& a, const auto& b) { return a.second < b.second; });
      ++landmarks_of_label[most->first];
      ++score_.landmarks_with_label;
    }
    score_.labels_mapped = landmarks_of_label.size();
    score_.labels_seen = of_label_.size();
  }

  AssociationScore score_;
  core::MergedIds merged_;
  std::map<Label, std::pair<std::int64_t, int>> last_seen_;  ///< scan and number of the visit
  std::map<Label, std::size_t> of_label_;
  std::map<Visit, std::size_t> of_visit_;
  std::map<LandmarkId, std::map<Visit, std::size_t>> by_landmark_;
  std::map<LandmarkId, Label> identity_;
  std::map<Label, bool> begun_;
};

}  // namespace

double AssociationScore::precision() const { return share(pairs_right, pairs_on_one_landmark); }
double AssociationScore::recall() const { return share(pairs_right, pairs_of_label); }
double AssociationScore::recall_in_visit() const { return share(pairs_right_in_visit, pairs_of_visit); }

double AssociationScore::landmarks_per_true_one() const {
  if (labels_mapped == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(landmarks_with_label) / static_cast<double>(labels_mapped);
}

AssociationScore& AssociationScore::operator+=(const AssociationScore& other) {
  labelled += other.labelled;
  right += other.right;
  wrong += other.wrong;
  missed += other.missed;
  spurious += other.spurious;
  pairs_on_one_landmark += other.pairs_on_one_landmark;
  pairs_right += other.pairs_right;
  pairs_of_label += other.pairs_of_label;
  pairs_of_visit += other.pairs_of_visit;
  pairs_right_in_visit += other.pairs_right_in_visit;
  landmarks_with_label += other.landmarks_with_label;
  labels_mapped += other.labels_mapped;
  labels_seen += other.labels_seen;
  return *this;
}

AssociationScore score_associations(const std::vector<core::StepReport>& steps,
                                    const std::vector<std::vector<core::Label>>& labels,
                                    const std::vector<core::MapLandmark>& map) {
  Scorer scorer(steps);
  for (std::size_t scan = 0; scan < steps.size(); ++scan) {
    for (const core::AssociationReport& association : steps[scan].associations) {
      const auto k = static_cast<std::size_t>(association.observation);
      const bool known = scan < labels.size() && k < labels[scan].size();
      scorer.add(steps[scan], association, known ? labels[scan][k] : core::no_label);
    }
  }
  return scorer.finish(map);
}

}  // namespace helixnav::evaluation
