// SPDX-License-Identifier: BSD-3-Clause
#include "merge_campaigns.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>

#include "campaign_files.hpp"
#include "campaign_summary.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/files/file.hpp"
#include "team_campaign.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

std::uint64_t seed_of(const Json& row) { return row.at("seed").get<std::uint64_t>(); }

/// A part that was killed is resumed by the command that began it: until then its campaign is incomplete.
void check_whole(const std::string& part, const Json& manifest, const std::vector<Json>& rows) {
  std::set<std::uint64_t> driven;
  for (const Json& row : rows) driven.insert(seed_of(row));
  std::uint64_t missing = 0, first_missing = 0;
  for (const auto& [first, last] : seed_ranges(manifest)) {
    for (std::uint64_t seed = first; seed <= last; ++seed) {
      if (driven.count(seed) > 0) continue;
      if (missing++ == 0) first_missing = seed;
    }
  }
  if (missing == 0) return;
  throw core::InputError(part + ": " + std::to_string(missing) + " of its seeds were not driven, the first is " +
                         std::to_string(first_missing) + "; give the command that began it again");
}

struct Merged {
  Json manifest;
  SeedRanges seeds;
  std::map<std::uint64_t, std::string> part_of;  ///< [seed]
  std::vector<Json> rows;
};

void add_part(const std::string& part, Merged& merged) {
  const Json manifest = campaign_manifest(part);
  if (merged.manifest.is_null()) merged.manifest = manifest;
  const std::string difference = first_difference(manifest, merged.manifest);
  if (!difference.empty()) {
    throw core::InputError(part + '/' + manifest_name + ": another campaign than the first part: " + difference +
                           " in the first part");
  }
  std::vector<Json> rows = campaign_rows(part);
  check_whole(part, manifest, rows);
  const SeedRanges seeds = seed_ranges(manifest);
  merged.seeds.insert(merged.seeds.end(), seeds.begin(), seeds.end());
  for (Json& row : rows) {
    const auto [held, is_new] = merged.part_of.emplace(seed_of(row), part);
    if (!is_new) {
      throw core::InputError(part + ": seed " + std::to_string(seed_of(row)) + " is in " + held->second + ", too");
    }
    merged.rows.push_back(std::move(row));
  }
}

/// If a part were read first and then overwritten, it would be lost.
void check_is_none_of(const std::vector<std::string>& parts, const std::string& out) {
  std::error_code unknown;
  for (const std::string& part : parts) {
    if (!fs::equivalent(part, out, unknown)) continue;
    throw core::InputError(out + ": --out is one of the parts to merge; choose another folder");
  }
}

void check_out(const std::string& out, bool overwrite) {
  if (fs::exists(out) && !fs::is_directory(out)) throw core::InputError(out + ": expected a folder, found a file");
  if (!fs::exists(out) || overwrite || fs::is_empty(out)) return;
  throw core::InputError(out + ": the folder is not empty; choose another --out, or --overwrite");
}

}  // namespace

void merge_campaigns(const std::vector<std::string>& parts, const std::string& out, bool overwrite) {
  check_is_none_of(parts, out);
  check_out(out, overwrite);
  if (!parts.empty() && campaign_manifest(parts.front()).value("scenario", std::string()) == team_scenario) {
    merge_team_campaigns(parts, out);
    return;
  }
  Merged merged;
  for (const std::string& part : parts) add_part(part, merged);
  sort_by_seed(merged.rows);
  const SeedRanges seeds = fused(merged.seeds);
  check_no_seed_between_is_missing(seeds);
  if (!seeds.empty()) merged.manifest["seeds"] = seeds;
  std::error_code error;
  fs::create_directories(out, error);
  if (error) throw core::InputError(out + ": cannot make the folder: " + error.message());
  const Json summary = summary_of(merged.manifest.value("scenario", std::string()), merged.rows);
  files::write_whole_file(out + '/' + manifest_name, merged.manifest.dump(2) + '\n');
  files::write_whole_file(out + '/' + rows_name, text_of_rows(merged.rows));
  files::write_whole_file(out + '/' + summary_name, summary.dump(2) + '\n');
  std::fputs(summary_text(summary).c_str(), stdout);
  std::printf("%zu parts merged; runs: %s/runs.jsonl   summary: %s/summary.json\n", parts.size(), out.c_str(),
              out.c_str());
}

}  // namespace helixnav::apps
