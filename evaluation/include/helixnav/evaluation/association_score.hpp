// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::evaluation {

/// How the associations of a run compare with labels. Stored as counts, so that several runs can be added up.
struct AssociationScore {
  /// A visit to a label ends when it has not been seen for more than this many scans.
  static constexpr std::int64_t visit_gap_scans = 150;

  // Observation by observation. A landmark takes the label of the first labelled observation attributed to it.
  std::size_t labelled = 0;  ///< observations with a label
  std::size_t right = 0;     ///< matched to a landmark of the same label
  std::size_t wrong = 0;     ///< matched to a landmark of another label
  std::size_t missed = 0;    ///< matched to none although the label had a landmark (kept out, or started again)
  std::size_t spurious = 0;  ///< observations without a label that were matched

  // Pairs of labelled observations. Independent of what a landmark is called.
  std::size_t pairs_on_one_landmark = 0;
  std::size_t pairs_right = 0;     ///< of those, both with the same label
  std::size_t pairs_of_label = 0;  ///< all with the same label, used by the filter or not
  std::size_t pairs_of_visit = 0;  ///< of those, within one visit
  std::size_t pairs_right_in_visit = 0;

  // The map at the end: mature landmarks, each taken as the label it was given most often.
  std::size_t landmarks_with_label = 0;
  std::size_t labels_mapped = 0;
  std::size_t labels_seen = 0;

  double precision() const;               ///< pairs_right / pairs_on_one_landmark; 1 without pairs
  double recall() const;                  ///< pairs_right / pairs_of_label; 1 without pairs
  double recall_in_visit() const;         ///< the same within visits: does not require loop closing
  double landmarks_per_true_one() const;  ///< landmarks_with_label / labels_mapped; NaN if none mapped
  AssociationScore& operator+=(const AssociationScore& other);
};

/// Scores the reports of a run in the order of its scans; landmarks merged by a closure count as one in all pairs.
/// `labels` is [scan][observation]; steps beyond it count as without label. `map` may be empty.
/// Cost O(observations · log). Test: evaluation/association_score_test.cpp (pairs counted one by one).
AssociationScore score_associations(const std::vector<core::StepReport>& steps,
                                    const std::vector<std::vector<core::Label>>& labels,
                                    const std::vector<core::MapLandmark>& map);

}  // namespace helixnav::evaluation
