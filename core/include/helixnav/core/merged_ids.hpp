// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "helixnav/core/landmark_id.hpp"
#include "helixnav/core/step_report.hpp"

namespace helixnav::core {

/// Which landmark each one is now, after merges. What a merge keeps exists, whatever happened to it before: a merge
/// that a rollback has undone may be followed by one the other way round, and no chain of merges is circular.
/// Test: core/merged_ids_test.cpp.
class MergedIds {
 public:
  MergedIds() = default;
  /// After all merges of a run.
  explicit MergedIds(const std::vector<StepReport>& steps);

  void merge(const MergedLandmarks& pair);

  /// The landmark that `id` is now: itself unless it was removed. Cost O(merges of it · log).
  LandmarkId now(LandmarkId id) const;

 private:
  std::map<LandmarkId, LandmarkId> kept_of_;  ///< by the removed one
};

}  // namespace helixnav::core
