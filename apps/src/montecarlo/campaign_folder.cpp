// SPDX-License-Identifier: BSD-3-Clause
#include "campaign_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "campaign.hpp"
#include "campaign_files.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/version.hpp"
#include "helixnav/files/file.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

/// The settings in force, one per line with its section; lines that only help the reader are left out.
Json config_lines(const std::string& config) {
  Json lines = Json::array();
  std::string section;
  std::istringstream stream(config);
  for (std::string line; std::getline(stream, line);) {
    if (line.empty() || line.front() == '#') continue;
    if (line.front() == '[') {
      section = line.substr(1, line.find(']') - 1) + '.';
    } else {
      lines.push_back(section + line);
    }
  }
  return lines;
}

Json manifest_of(const Campaign& campaign) {
  return {{"format", campaign_format},
          {"version", core::version()},
          {"commit", core::commit()},
          {"scenario", campaign.scenario.name},
          {"config", config_lines(campaign.config)},
          {"seeds", Json::array({Json::array({campaign.first_seed, campaign.first_seed + campaign.runs - 1})})}};
}

}  // namespace

CampaignFolder::CampaignFolder(const Campaign& campaign) : path_(campaign.out) {
  const fs::path folder(path_);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) {
    throw core::InputError(path_ + ": expected a folder for --out" + (error ? ", cannot make it" : ", found a file"));
  }
  lock_.emplace(path_);
  if (campaign.overwrite) {
    for (const char* name : {manifest_name, rows_name, summary_name}) fs::remove(folder / name, error);
  }
  const Json manifest = manifest_of(campaign);
  if (fs::exists(folder / manifest_name)) {
    take_up(manifest);
  } else if (!fs::is_empty(folder) && !campaign.overwrite) {
    throw core::InputError(path_ + ": the folder is not empty and holds no campaign; choose another --out");
  } else {
    files::write_whole_file((folder / manifest_name).string(), manifest.dump(2) + '\n');
  }
  write_rows(fs::exists(folder / rows_name) ? campaign_rows(path_) : std::vector<Json>{});
}

void CampaignFolder::take_up(Json manifest) const {
  const Json held = campaign_manifest(path_);
  const std::string difference = first_difference(held, manifest);
  const std::string file = path_ + '/' + manifest_name;
  if (!difference.empty()) {
    throw core::InputError(file + ": the folder holds another campaign: " + difference +
                           "; choose another --out, or --overwrite to begin it anew");
  }
  SeedRanges ranges = seed_ranges(held);
  const SeedRanges more = seed_ranges(manifest);
  ranges.insert(ranges.end(), more.begin(), more.end());
  manifest["seeds"] = fused(ranges);
  if (manifest != held) files::write_whole_file(file, manifest.dump(2) + '\n');
}

void CampaignFolder::write_rows(const std::vector<Json>& rows) {
  const std::string file = path_ + '/' + rows_name;
  rows_.close();
  files::write_whole_file(file, text_of_rows(rows));
  rows_.open(file, std::ios::binary | std::ios::app);
}

std::set<std::uint64_t> CampaignFolder::seeds() const {
  std::set<std::uint64_t> seeds;
  for (const Json& row : campaign_rows(path_)) seeds.insert(row.at("seed").get<std::uint64_t>());
  return seeds;
}

void CampaignFolder::append(const std::string& row) {
  rows_ << row + '\n' << std::flush;
  if (!rows_) throw core::InputError(path_ + '/' + rows_name + ": cannot be written");
}

std::vector<Json> CampaignFolder::sort() {
  std::vector<Json> rows = campaign_rows(path_);
  sort_by_seed(rows);
  write_rows(rows);
  return rows;
}

void CampaignFolder::write_summary(const Json& summary) const {
  files::write_whole_file(path_ + '/' + summary_name, summary.dump(2) + '\n');
}

}  // namespace helixnav::apps
