// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/core/step_report.hpp"
#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/runs/run.hpp"
#include "json.hpp"

namespace helixnav::reports {

/// What the page draws over time or along the path, thinned to what a screen shows.
Json path_json(const std::vector<core::StepReport>& steps);
/// Null if the path was not corrected.
Json final_path_json(const runs::Run& run);
Json truth_json(const evaluation::PositionEvaluation& position);
Json errors_json(const evaluation::PositionEvaluation& position);
Json heading_json(const std::vector<evaluation::HeadingError>& errors);
Json health_json(const std::vector<core::StepReport>& steps);
Json nis_json(const std::vector<core::StepReport>& steps);
Json observations_json(const std::vector<core::StepReport>& steps);

}  // namespace helixnav::reports
