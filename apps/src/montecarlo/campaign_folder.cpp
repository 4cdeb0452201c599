// SPDX-License-Identifier: BSD-3-Clause
#include "campaign_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <sstream>

#include "campaign.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/version.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/files/json_nesting.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* format_name = "helixnav-campaign-1";
constexpr const char* manifest_name = "manifest.json";
constexpr const char* rows_name = "runs.jsonl";
constexpr const char* summary_name = "summary.json";

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw core::InputError(file.string() + ": cannot be read");
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Of what the summary asks a row for; numbers of any other type count as none.
void check_row(const std::string& file, std::size_t line, const Json& row) {
  const std::string here = file + ':' + std::to_string(line) + ": expected the JSON object of a run";
  if (!row.is_object() || !row.contains("seed") || !row.contains("verdict")) throw core::InputError(here);
  const auto require = [&](const char* key, bool right) {
    if (!right) throw core::InputError(here + ", found \"" + key + "\": " + row.at(key).dump().substr(0, 60));
  };
  require("seed", row.at("seed").is_number_unsigned());
  require("verdict", row.at("verdict").is_string());
  for (const char* key : {"diverged_after_closure", "late", "closed_by_association"}) {
    if (row.contains(key)) require(key, row.at(key).is_boolean());
  }
  for (const char* key : {"returns", "closures"}) {
    if (row.contains(key)) require(key, row.at(key).is_array());
  }
  for (const char* key : {"end", "wall"}) {
    if (row.contains(key)) require(key, row.at(key).is_object());
  }
}

/// The settings in force, one a line with its section; what only helps to read is left out.
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
  return {{"format", format_name},
          {"version", core::version()},
          {"commit", core::commit()},
          {"scenario", campaign.scenario.name},
          {"config", config_lines(campaign.config)}};
}

std::string first_difference(const Json& held, const Json& wanted) {
  for (const char* key : {"format", "version", "commit", "scenario"}) {
    if (held.value(key, Json()) != wanted.at(key)) {
      return std::string(key) + " " + held.value(key, Json()).dump() + ", now " + wanted.at(key).dump();
    }
  }
  const Json lines = held.value("config", Json::array());
  for (std::size_t i = 0; i < std::max(lines.size(), wanted.at("config").size()); ++i) {
    const Json was = i < lines.size() ? lines[i] : Json();
    const Json is = i < wanted.at("config").size() ? wanted.at("config")[i] : Json();
    if (was != is) return was.dump() + ", now " + is.dump();
  }
  return {};
}

}  // namespace

CampaignFolder::CampaignFolder(const Campaign& campaign) : path_(campaign.out) {
  const fs::path folder(path_);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) {
    throw core::InputError(path_ + ": expected a folder for --out" + (error ? ", cannot make it" : ", found a file"));
  }
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
  write_rows(fs::exists(folder / rows_name) ? read_rows() : std::vector<Json>{});
}

void CampaignFolder::take_up(const Json& manifest) const {
  const std::string file = path_ + '/' + manifest_name;
  const std::string text = text_of(file);
  files::check_json_nesting(file, text);
  const Json held = Json::parse(text, nullptr, false);
  if (!held.is_object() || held.value("format", Json()) != format_name) {
    throw core::InputError(file + ": not the manifest of a campaign; choose another --out");
  }
  const std::string difference = first_difference(held, manifest);
  if (difference.empty()) return;
  throw core::InputError(file + ": the folder holds another campaign: " + difference +
                         "; choose another --out, or --overwrite to begin it anew");
}

std::vector<Json> CampaignFolder::read_rows() const {
  const std::string file = path_ + '/' + rows_name;
  const std::string text = text_of(file);
  files::check_json_nesting(file, text);
  std::vector<Json> rows;
  std::size_t begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; begin = end + 1, end = text.find('\n', begin)) {
    const auto first = text.begin() + static_cast<std::ptrdiff_t>(begin);
    Json row = Json::parse(first, text.begin() + static_cast<std::ptrdiff_t>(end), nullptr, false);
    check_row(file, rows.size() + 1, row);
    rows.push_back(std::move(row));
  }
  return rows;
}

void CampaignFolder::write_rows(const std::vector<Json>& rows) {
  std::string text;
  for (const Json& row : rows) text += row.dump() + '\n';
  const std::string file = path_ + '/' + rows_name;
  rows_.close();
  files::write_whole_file(file, text);
  rows_.open(file, std::ios::binary | std::ios::app);
}

std::set<std::uint64_t> CampaignFolder::seeds() const {
  std::set<std::uint64_t> seeds;
  for (const Json& row : read_rows()) seeds.insert(row.at("seed").get<std::uint64_t>());
  return seeds;
}

void CampaignFolder::append(const std::string& row) {
  rows_ << row + '\n' << std::flush;
  if (!rows_) throw core::InputError(path_ + '/' + rows_name + ": cannot be written");
}

std::vector<Json> CampaignFolder::sort() {
  std::vector<Json> rows = read_rows();
  std::sort(rows.begin(), rows.end(), [](const Json& a, const Json& b) {
    return a.at("seed").get<std::uint64_t>() < b.at("seed").get<std::uint64_t>();
  });
  write_rows(rows);
  return rows;
}

void CampaignFolder::write_summary(const Json& summary) const {
  files::write_whole_file(path_ + '/' + summary_name, summary.dump(2) + '\n');
}

}  // namespace helixnav::apps
