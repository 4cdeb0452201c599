// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/runs/run.hpp"
#include "json.hpp"

namespace helixnav::reports {

/// What the report says first: {"sentences": […], "warnings": […]}. Test: reports/opening_test.cpp.
Json opening_data(const runs::Run& run, const evaluation::Evaluation& evaluation);

/// Position error where the truth is known last before a step of the run and next at or after it.
struct ErrorAround {
  std::optional<double> before_m, after_m;
};
ErrorAround error_around(const runs::Run& run, std::size_t k, const evaluation::Evaluation& evaluation);

}  // namespace helixnav::reports
