// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace helixnav::apps {

/// Summarises the lines of runs.jsonl (docs/campaign.md). Shares of runs come with their two-sided 95 %
/// Clopper-Pearson interval, means of NEES with the 95 % band of as many independent consistent ones. A figure
/// without data is null.
nlohmann::ordered_json summary_of(const std::string& scenario, const std::vector<nlohmann::ordered_json>& rows);

/// For the terminal: one figure per line.
std::string summary_text(const nlohmann::ordered_json& summary);

}  // namespace helixnav::apps
