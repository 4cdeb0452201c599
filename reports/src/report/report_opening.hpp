// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/runs/run.hpp"
#include "json.hpp"

namespace helixnav::reports {

/// The opening of the report: {"sentences": […], "warnings": […]}. Test: reports/opening_test.cpp.
Json opening_data(const runs::Run& run, const evaluation::Evaluation& evaluation);

/// Position error at the last known truth before a step of the run and at the next one at or after it.
struct ErrorAround {
  std::optional<double> before_m, after_m;
};
ErrorAround error_around(const runs::Run& run, std::size_t k, const evaluation::Evaluation& evaluation);

}  // namespace helixnav::reports
