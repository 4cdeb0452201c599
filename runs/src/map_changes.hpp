// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "helixnav/core/step_report.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::runs {

/// Tracks the map of a drive for its picture. Test: runs/run_recorder_test.cpp.
class MapChanges {
 public:
  MapChanges() = default;
  explicit MapChanges(std::size_t scans);

  /// Some hundred times per drive, and after every closing or solution of the drive. `report` as it came.
  bool wants(const core::StepReport& report) const;

  /// What a picture shows differently than at the last call: landmarks in order of id.
  MapChange since_last(std::int64_t step, const std::vector<core::MapLandmark>& map);

 private:
  std::int64_t every_ = 10;
  std::size_t told_ = 0;                  ///< landmarks in all changes until now
  std::vector<core::MapLandmark> shown_;  ///< as reported by the changes until now, in order of id
};

}  // namespace helixnav::runs
