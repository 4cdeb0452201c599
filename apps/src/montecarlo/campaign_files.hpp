// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace helixnav::apps {

using Json = nlohmann::ordered_json;

inline constexpr const char* campaign_format = "helixnav-campaign-1";
inline constexpr const char* manifest_name = "manifest.json";
inline constexpr const char* rows_name = "runs.jsonl";
inline constexpr const char* summary_name = "summary.json";

/// First and last seed, both inclusive.
using SeedRanges = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

/// Of the folder of a campaign. InputError naming the file if it cannot be read or is not a manifest.
Json campaign_manifest(const std::string& folder);

/// The lines of its runs.jsonl; an incomplete last line is left out. InputError naming file and line for a line that is not
/// a run.
std::vector<Json> campaign_rows(const std::string& folder);

std::string text_of_rows(const std::vector<Json>& rows);
void sort_by_seed(std::vector<Json>& rows);

/// Why two manifests are not of the same campaign, in words; empty if they are. Seeds do not count.
std::string first_difference(const Json& held, const Json& wanted);

/// The seeds requested for the folder; none in a manifest of versions before they were recorded. campaign_manifest has checked them.
SeedRanges seed_ranges(const Json& manifest);

/// In order, with neighbouring and overlapping ranges merged.
SeedRanges fused(SeedRanges ranges);

/// InputError naming the seeds between the first and the last that no range contains: a part was forgotten, or never
/// driven.
void check_no_seed_between_is_missing(const SeedRanges& fused);

}  // namespace helixnav::apps
