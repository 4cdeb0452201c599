// SPDX-License-Identifier: BSD-3-Clause
#include "team_campaign.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "campaign_files.hpp"
#include "common/progress_bar.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/version.hpp"
#include "helixnav/core/worker_pool.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/files/folder_lock.hpp"
#include "team_campaign_table.hpp"
#include "team_trial.hpp"

namespace helixnav::apps {
namespace {

void make_folder(const TeamCampaign& campaign) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::create_directories(campaign.out, error);
  if (error) throw core::InputError(campaign.out + ": cannot make the folder: " + error.message());
  if (campaign.overwrite || fs::is_empty(campaign.out)) return;
  throw core::InputError(campaign.out + ": the folder is not empty; choose another --out, or --overwrite");
}

std::vector<TeamWorld> worlds_of(const TeamCampaign& campaign) {
  std::vector<TeamWorld> worlds;
  for (std::uint64_t run = 0; run < campaign.runs; ++run) {
    const std::uint64_t seed = campaign.first_seed + run;
    for (const TeamTrial& trial : trials_of(seed)) worlds.push_back({seed, trial, {}});
  }
  return worlds;
}

Json manifest_of(const TeamCampaign& campaign) {
  return {{"format", campaign_format},
          {"version", core::version()},
          {"commit", core::commit()},
          {"scenario", team_scenario},
          {"config", Json::array()},
          {"seeds", Json::array({Json::array({campaign.first_seed, campaign.first_seed + campaign.runs - 1})})}};
}

void write_summary(const std::vector<TeamWorld>& worlds, const std::string& out) {
  const Json summary = team_campaign_summary(worlds);
  files::write_whole_file(out + '/' + summary_name, summary.dump(2) + '\n');
  print_team_campaign(summary);
}

/// The worlds of a part, all of those that its manifest promises.
std::vector<TeamWorld> whole_part(const std::string& part, const Json& manifest) {
  std::vector<TeamWorld> worlds = read_team_rows(part);
  std::map<std::uint64_t, std::size_t> driven;
  for (const TeamWorld& world : worlds) ++driven[world.seed];
  for (const auto& [first, last] : seed_ranges(manifest)) {
    for (std::uint64_t seed = first; seed <= last; ++seed) {
      if (driven[seed] == trials_of(seed).size()) continue;
      throw core::InputError(part + ": not all worlds of its seeds were driven, the first seed is " +
                             std::to_string(seed) + "; give the command that began it again, with --overwrite");
    }
  }
  return worlds;
}

}  // namespace

void merge_team_campaigns(const std::vector<std::string>& parts, const std::string& out) {
  Json merged;
  SeedRanges seeds;
  std::vector<TeamWorld> worlds;
  std::map<std::uint64_t, std::string> part_of;
  for (const std::string& part : parts) {
    const Json manifest = campaign_manifest(part);
    if (merged.is_null()) merged = manifest;
    const std::string difference = first_difference(manifest, merged);
    if (!difference.empty()) {
      throw core::InputError(part + '/' + manifest_name + ": another campaign than the first part: " + difference +
                             " in the first part");
    }
    const SeedRanges ranges = seed_ranges(manifest);
    seeds.insert(seeds.end(), ranges.begin(), ranges.end());
    for (TeamWorld& world : whole_part(part, manifest)) {
      const std::string& held = part_of.emplace(world.seed, part).first->second;
      if (held != part) {
        throw core::InputError(part + ": seed " + std::to_string(world.seed) + " is in " + held + ", too");
      }
      worlds.push_back(std::move(world));
    }
  }
  const SeedRanges whole = fused(seeds);
  check_no_seed_between_is_missing(whole);
  std::stable_sort(worlds.begin(), worlds.end(),
                   [](const TeamWorld& a, const TeamWorld& b) { return a.seed < b.seed; });
  merged["seeds"] = whole;
  std::filesystem::create_directories(out);
  files::write_whole_file(out + '/' + manifest_name, merged.dump(2) + '\n');
  files::write_whole_file(out + '/' + team_rows_name, team_columns + team_rows(worlds, 0, worlds.size()));
  write_summary(worlds, out);
}

ExitCode run_team_campaign(const TeamCampaign& campaign) {
  make_folder(campaign);
  const files::FolderLock lock(campaign.out);
  std::vector<TeamWorld> worlds = worlds_of(campaign);
  core::WorkerPool workers(campaign.jobs);
  ProgressBar progress("driving", worlds.size(), campaign.quiet);
  const std::size_t batch = std::size_t{4} * campaign.jobs;
  files::write_whole_file(campaign.out + '/' + manifest_name, manifest_of(campaign).dump(2) + '\n');
  std::filesystem::remove(campaign.out + '/' + team_rows_name);
  files::AppendFile table(campaign.out + '/' + team_rows_name);
  table.append(team_columns);
  for (std::size_t done = 0; done < worlds.size(); done += batch) {
    const std::size_t count = std::min(batch, worlds.size() - done);
    workers.for_each(count, [&](std::size_t i) {
      TeamWorld& world = worlds[done + i];
      world.verdict = judge_world(world.trial, world.seed);
    });
    table.append(team_rows(worlds, done, count));
    progress.advance_to(done + count);
  }
  write_summary(worlds, campaign.out);
  return ExitCode::ok;
}

}  // namespace helixnav::apps
