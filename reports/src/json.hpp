// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::reports {

/// Keys keep their insertion order.
using Json = nlohmann::ordered_json;

/// `json` over several lines; bytes that are not UTF-8 (from a file name, say) become U+FFFD.
std::string json_text(const Json& json);

Json evaluation_to_json(const evaluation::Evaluation& evaluation);

/// Wall-clock figures of a run: quantiles of the step times, then the run's own.
Json timing_to_json(const runs::Run& run);

/// summary.json, without the run's own numbers and without "timing".
Json summary_to_json(const runs::Run& run, const evaluation::Evaluation& evaluation);

}  // namespace helixnav::reports
