// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "helixnav/core/step_report.hpp"

namespace helixnav::runs {

/// Makes `association` what is known of that observation of step number `step`, in place of what was known before. Steps
/// are ascending, and so are the observations of a step; a step that is not there is passed over. Cost: a bisection, where
/// observations come in order.
void put_association(std::int64_t step, const core::AssociationReport& association,
                     std::vector<core::StepReport>& steps);

}  // namespace helixnav::runs
