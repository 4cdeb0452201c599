// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/core/step_report.hpp"
#include "helixnav/pf_relocalize/constellation.hpp"

namespace helixnav::supervisor {

/// What closing a loop did, or would have done.
struct Closing {
  bool accepted = false;
  double cost = 0.0;  ///< J of the pairs kept, χ² with dof
  int dof = 0;
  double limit = 0.0;
  double limit_of_leftovers = 0.0;            ///< sum, for what was merged after the pairs
  core::NumericalHealth numerics;             ///< repairs and refusals only
  int dropped = 0;                            ///< pairs dropped because of their cost
  std::vector<core::MergedLandmarks> merged;  ///< empty unless accepted
  std::vector<core::LandmarkId> forgotten;    ///< unconfirmed ones that coincided with an old landmark
};

/// Landmarks mapped since the old ones were excluded, ascending.
struct Branch {
  std::vector<core::LandmarkId> confirmed;    ///< seen often enough to be merged with an old landmark
  std::vector<core::LandmarkId> unconfirmed;  ///< may be clutter: never merged
  pf_relocalize::Coverage old_drive;          ///< map frame
  pf_relocalize::Coverage new_drive;          ///< map frame as it was before the closing
  core::MapAppearance appearance = {};        ///< of all landmarks: different ones are not copies
};

}  // namespace helixnav::supervisor
