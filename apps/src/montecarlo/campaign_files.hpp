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

/// First and last seed, both in it.
using SeedRanges = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

/// Of the folder of a campaign. InputError naming the file where it cannot be read or is none.
Json campaign_manifest(const std::string& folder);

/// The lines of its runs.jsonl; a last one without its end is left out. InputError naming file and line for what is no run.
std::vector<Json> campaign_rows(const std::string& folder);

std::string text_of_rows(const std::vector<Json>& rows);
void sort_by_seed(std::vector<Json>& rows);

/// What of two manifests is not the same campaign, in words; empty when nothing is. Seeds do not count.
std::string first_difference(const Json& held, const Json& wanted);

/// The seeds that the folder was asked for; none in a manifest of versions before they were noted. campaign_manifest has checked them.
SeedRanges seed_ranges(const Json& manifest);

/// In order, neighbours and overlapping ones as one.
SeedRanges fused(SeedRanges ranges);

/// InputError naming the seeds between the first and the last that no range holds: a part was forgotten, or never driven.
void check_no_seed_between_is_missing(const SeedRanges& fused);

}  // namespace helixnav::apps
