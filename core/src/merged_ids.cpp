// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/merged_ids.hpp"

namespace helixnav::core {

MergedIds::MergedIds(const std::vector<StepReport>& steps) {
  for (const StepReport& step : steps) {
    for (const MergedLandmarks& pair : step.merged) merge(pair);
  }
}

void MergedIds::merge(const MergedLandmarks& pair) {
  kept_of_.erase(pair.kept);
  if (pair.kept != pair.removed) kept_of_[pair.removed] = pair.kept;
}

LandmarkId MergedIds::now(LandmarkId id) const {
  for (auto kept = kept_of_.find(id); kept != kept_of_.end(); kept = kept_of_.find(id)) id = kept->second;
  return id;
}

}  // namespace helixnav::core
