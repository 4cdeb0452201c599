// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "helixnav/core/step_report.hpp"

namespace helixnav::runs {

/// Makes `association` what is known of that observation of step number `step`, replacing what was known before. Steps
/// are ascending, and so are the observations of a step; a missing step is skipped. Cost: a bisection, if observations
/// come in order.
void put_association(std::int64_t step, const core::AssociationReport& association,
                     std::vector<core::StepReport>& steps);

}  // namespace helixnav::runs
