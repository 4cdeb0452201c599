// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "helixnav/logs/evaluation.hpp"
#include "helixnav/logs/run_folder.hpp"
#include "helixnav/logs/run_manifest.hpp"
#include "helixnav/logs/run_writer.hpp"

namespace helixnav::logs {

/// Keys keep the order in which they were put in.
using Json = nlohmann::ordered_json;

/// `json` over several lines; bytes that are not UTF-8 (from a file name, say) become U+FFFD.
std::string json_text(const Json& json);

Json manifest_to_json(const RunManifest& manifest);

/// Reads what manifest_to_json made. InputError names `path`.
RunManifest manifest_from_text(const std::string& path, const std::string& text);

Json evaluation_to_json(const Evaluation& evaluation);

/// Wall-clock figures of a run: quantiles of the step times, then the caller's own.
Json timing_to_json(const std::vector<double>& microseconds, const std::vector<std::pair<std::string, double>>& timing);

/// summary.json, without "timing".
Json summary_to_json(const RunFolder& run, const Evaluation& evaluation,
                     const std::vector<std::pair<std::string, double>>& numbers);

}  // namespace helixnav::logs
