// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "helixnav/core/step_report.hpp"

namespace helixnav::apps {

/// Whether a scan re-observed a landmark.
inline bool has_match(const core::StepReport& step) {
  return std::any_of(step.associations.begin(), step.associations.end(),
                     [](const core::AssociationReport& a) { return a.outcome == core::Outcome::matched; });
}

}  // namespace helixnav::apps
